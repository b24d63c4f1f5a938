#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
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
constexpr Vec3 operator-(const Vec3& a) noexcept { return {-a[0], -a[1], -a[2]}; }
constexpr Vec3 operator*(double s, const Vec3& a) noexcept { return {s * a[0], s * a[1], s * a[2]}; }
constexpr double dot(const Vec3& a, const Vec3& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double length(const Vec3& a) noexcept { return std::sqrt(dot(a, a)); }

}  // namespace orchard::runtime

// For structured bindings.
template <>
struct std::tuple_size<orchard::runtime::Vec3> : std::integral_constant<std::size_t, 3> {};
template <std::size_t i>
struct std::tuple_element<i, orchard::runtime::Vec3> {
  using type = double;
};

namespace orchard::runtime {

// Where an instance of a body is: world = scale * rotation * body + translation. Rotation is row-major.
// Every query asks is_rigid() first, and of a pose that is not (zeros, a mirror, shear, scales that differ between
// axes, what is not a number, and also a rotation whose entries were rounded to float) it says that nothing is known:
// "maybe" without bounds, or what each function names. Radii would be wrong otherwise, and so would a "no". Rotations
// kept in floats, or integrated over many frames, are made rigid by made_rigid() or pose_from_matrix() first.
struct Pose {
  std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> translation = {0, 0, 0};
  double scale = 1;  // uniform

  friend bool operator==(const Pose&, const Pose&) = default;
};

// With rows a, b, c of the rotation: on the root of the sum of the squares of |a|^2 - 1, |b|^2 - 1, a . b and the
// components of c - a x b.
inline constexpr double kRigidTolerance = 1e-12;
inline constexpr double kScaleLimit = 1e100;         // a scale is between 1 / kScaleLimit and kScaleLimit
inline constexpr double kMaxRelativeScale = 0x1p44;  // of one body of a pair to the other
inline constexpr double kRepairTolerance = 1e-3;     // as kRigidTolerance, of what made_rigid() repairs

// Whether queries can answer for a pose: a proper rotation to within kRigidTolerance, a scale within its limits,
// nothing that is not finite. Some ten nanoseconds; queries do it themselves.
bool is_rigid(const Pose& pose) noexcept;

// The rotation nearest to pose.rotation, with the same translation and scale, so that is_rigid() holds: for matrices of
// floats, and products of many. It moves no point of a body of radius R farther than rounding had moved it already:
// some 1e-7 R for floats. Nothing if the matrix is farther than kRepairTolerance from a proper rotation, or if anything
// else is wrong. Costs some 100 ns.
std::optional<Pose> made_rigid(const Pose& pose) noexcept;
std::optional<Pose> pose_from_matrix(const std::array<float, 9>& rotation, const std::array<float, 3>& translation,
                                     float scale = 1) noexcept;

// From a quaternion (w, x, y, z) of any length; nothing if it is zero or anything is not finite.
std::optional<Pose> pose_from_quaternion(const std::array<double, 4>& wxyz,
                                         const std::array<double, 3>& translation) noexcept;

Pose compose(const Pose& outer, const Pose& inner) noexcept;  // outer after inner
Pose inverse(const Pose& pose) noexcept;

inline std::array<double, 3> rotate(const Pose& pose, const std::array<double, 3>& v) noexcept {
  const auto& r = pose.rotation;
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
          r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}

inline std::array<double, 3> transform(const Pose& pose, const std::array<double, 3>& point) noexcept {
  const auto v = rotate(pose, point);
  return {pose.scale * v[0] + pose.translation[0], pose.scale * v[1] + pose.translation[1],
          pose.scale * v[2] + pose.translation[2]};
}

// The points origin + t direction, 0 <= t <= longest; direction of any length but 0.
struct Ray {
  std::array<double, 3> origin{}, direction{};
  double longest = std::numeric_limits<double>::infinity();
};

}  // namespace orchard::runtime
