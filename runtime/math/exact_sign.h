#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include "orchard/runtime/pose.h"

// Signs of determinants of double coordinates. They are exact if the coordinates are at most 1e100 and multiples of
// 2^-357, as all doubles are that are 0 or at least 2^-305: then no product of three differences, and no part of one,
// underflows or overflows. The usual case costs one evaluation in double. Close cases are repeated with twice the
// digits, and ties are evaluated in full.
namespace orchard::runtime::detail {

// Returns a value > 0 if a, b, c appear counterclockwise when seen from the side of their plane away from d, 0 if all
// four are coplanar, and otherwise a value < 0.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept;

// Returns the determinant whose sign orientation(a, b, c, d) is, six times the volume, right to 2^-40 of itself.
double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept;

// Returns the orientation in the plane that remains when `axis` is dropped: > 0 if a, b, c turn counterclockwise, 0 if
// they are collinear.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t axis) noexcept;

// Returns whether three points lie on one line. They do if they do in every plane that remains when an axis is dropped.
bool in_line(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

// The error of plain evaluation: every difference, product and sum has a relative error of a unit, 2^-53, and no term
// passes through more than eight of them. So a determinant is off by at most 8.1 units times the sum of the terms'
// sizes (the permanent), which is itself computed to 8.1 units. Twice that leaves room.
inline constexpr double kPlainDeterminantError = 16 * 0x1p-53;

// Computes orientation(a, b, c, d) for three fixed points and any d.
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
