#pragma once
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace orchard::runtime {

// Three numbers along x, y and z. A type of its own, so that its operators are found wherever it is used; and every
// std::array<double, 3>, as poses and contacts have, becomes one where one is asked for, and the other way round.
struct Vec3 : std::array<double, 3> {
  constexpr Vec3() noexcept : std::array<double, 3>{} {}
  constexpr Vec3(double x, double y, double z) noexcept : std::array<double, 3>{x, y, z} {}
  constexpr Vec3(const std::array<double, 3>& v) noexcept : std::array<double, 3>(v) {}  // NOLINT: implicit
};

constexpr Vec3 operator+(const Vec3& a, const Vec3& b) noexcept { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
constexpr Vec3 operator-(const Vec3& a, const Vec3& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
constexpr Vec3 operator*(double s, const Vec3& a) noexcept { return {s * a[0], s * a[1], s * a[2]}; }
constexpr double dot(const Vec3& a, const Vec3& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace orchard::runtime

// For structured bindings.
template <>
struct std::tuple_size<orchard::runtime::Vec3> : std::integral_constant<std::size_t, 3> {};
template <std::size_t i>
struct std::tuple_element<i, orchard::runtime::Vec3> {
  using type = double;
};
