#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include "orchard/runtime/pose.h"

// Signs of determinants of double coordinates. Exact if these are multiples of 2^-357, as all are that are 0 or at
// least 2^-305, and at most 1e100: no product of three differences, and no part of one, then underflows or overflows.
// The usual case costs one evaluation in double; close ones are repeated with twice the digits, ties in full.
namespace orchard::runtime::detail {

// > 0 if a, b, c appear counterclockwise when seen from the side of their plane away from d, 0 if all four are
// coplanar.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept;

// Its determinant, six times the volume, right to 2^-40 of itself.
double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept;

// The sign in the plane that remains when `axis` is dropped: > 0 if a, b, c turn counterclockwise, 0 if collinear.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t axis) noexcept;

// Whether three points lie on one line: so in every plane.
bool in_line(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

// Plain evaluation: every difference, product and sum has a relative error of a unit, 2^-53, and no term passes through
// more than eight of them, so that a determinant is off by at most 8.1 units times the sum of the terms' sizes (the
// permanent), which is itself computed to 8.1 units. Twice that leaves room.
inline constexpr double kPlainDeterminantError = 16 * 0x1p-53;

// orientation(a, b, c, d) of three points and any d.
class PlaneOrientation {
 public:
  explicit PlaneOrientation(const std::array<Vec3, 3>& points) noexcept : points_(points) {
    const Vec3 v = points[1] - points[0], w = points[2] - points[0];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      const double left = v[j] * w[k], right = v[k] * w[j];
      normal_[i] = left - right;
      size_[i] = std::fabs(left) + std::fabs(right);
    }
  }
  int operator()(const Vec3& d) const noexcept {
    const Vec3 u = points_[0] - d;
    const double determinant = dot(u, normal_);
    const double permanent = std::fabs(u[0]) * size_[0] + std::fabs(u[1]) * size_[1] + std::fabs(u[2]) * size_[2];
    if (std::fabs(determinant) > kPlainDeterminantError * permanent) return determinant > 0 ? 1 : -1;
    return orientation(points_[0], points_[1], points_[2], d);
  }

 private:
  const std::array<Vec3, 3>& points_;
  Vec3 normal_, size_;  // A vector across the plane, and the sums of its terms' sizes.
};

}  // namespace orchard::runtime::detail
