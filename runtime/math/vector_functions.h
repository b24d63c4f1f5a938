#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "math/exact_sign.h"

// Operations that exact tests, distances and the builder of triangle trees need in addition to those of Vec3.
namespace orchard::runtime::detail {

// These functions also take arrays, which the operators of Vec3 do not.
inline Vec3 minus(const Vec3& a, const Vec3& b) noexcept { return a - b; }
inline Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// Returns a + t d.
inline Vec3 along(const Vec3& a, const Vec3& d, double t) noexcept {
  return {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
}

// Returns v divided by its length, or 0 if v is 0.
inline Vec3 unit_or_zero(const Vec3& v) noexcept {
  const double size = length(v);
  return size > 0 ? along({0, 0, 0}, v, 1 / size) : Vec3{};
}
// Returns the unit vector of the coordinate axis along which v has its smallest component.
inline Vec3 least_axis(const Vec3& v) noexcept {
  std::size_t least = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::fabs(v[i]) < std::fabs(v[least])) least = i;
  }
  Vec3 axis{};
  axis[least] = 1;
  return axis;
}
inline double one_norm(const Vec3& v) noexcept { return std::fabs(v[0]) + std::fabs(v[1]) + std::fabs(v[2]); }

// A matrix, row by row.
using Matrix = std::array<double, 9>;
inline Matrix transposed(const Matrix& m) noexcept { return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}; }
inline Matrix product(const Matrix& a, const Matrix& b) noexcept {
  Matrix result;
  for (std::size_t i = 0; i < 9; i += 3) {
    for (std::size_t j = 0; j < 3; ++j) result[i + j] = a[i] * b[j] + a[i + 1] * b[3 + j] + a[i + 2] * b[6 + j];
  }
  return result;
}

// Returns v, rotated by the inverse of a pose's rotation.
inline Vec3 turned_back(const Pose& pose, const Vec3& v) noexcept {
  const auto& r = pose.rotation;
  return {r[0] * v[0] + r[3] * v[1] + r[6] * v[2], r[1] * v[0] + r[4] * v[1] + r[7] * v[2],
          r[2] * v[0] + r[5] * v[1] + r[8] * v[2]};
}

// Return a float above `value`. stored_above() leaves room for the rounding of a few operations in double.
inline float next_float(double value) noexcept {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}
inline float stored_above(double value) noexcept { return next_float(value * (1 + 1e-14)); }

// These do the same as std::ilogb() and std::ldexp(), without a call for the sizes that usually occur.
inline int exponent_of(double value) noexcept {  // of a finite value above 0
  const int power = static_cast<int>(std::bit_cast<std::uint64_t>(value) >> 52) - 1023;
  return power > -1023 ? power : std::ilogb(value);
}
inline double scaled(double value, int power) noexcept {
  if (power < -1000 || power > 1000) return std::ldexp(value, power);
  return value * std::bit_cast<double>(static_cast<std::uint64_t>(1023 + power) << 52);
}

// A vector multiplied by a power of two, so that its size is about 1 and no square of its components is lost. It is 0
// for a vector that has no direction.
struct ScaledVector {
  Vec3 value{};
  int power = 0;
  explicit ScaledVector(const Vec3& v) noexcept {
    double largest = 0;
    for (const double x : v) {
      if (!std::isfinite(x)) return;
      largest = std::fabs(x) > largest ? std::fabs(x) : largest;
    }
    if (largest == 0) return;
    power = -exponent_of(largest);
    for (std::size_t i = 0; i < 3; ++i) value[i] = scaled(v[i], power);
  }
};

// Returns the least power of two that is no less than x, which is above 0.
inline double power_above(double x) noexcept {
  constexpr std::uint64_t kMantissa = (std::uint64_t{1} << 52) - 1;
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) + kMantissa) & ~kMantissa);
}

// These do the same as std::min() and std::max(), but by value, so each is one instruction; the standard functions can
// become branches that cannot be predicted. If an argument is not a number, both return the first one.
inline double min(double a, double b) noexcept { return b < a ? b : a; }
inline double max(double a, double b) noexcept { return b > a ? b : a; }
inline double max_abs(const Vec3& v) noexcept { return max(max(std::fabs(v[0]), std::fabs(v[1])), std::fabs(v[2])); }

}  // namespace orchard::runtime::detail
