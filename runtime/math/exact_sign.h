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

// Plain evaluation: every difference, product and sum has a relative error of a unit, 2^-53, and no term passes through
// more than eight of them, so that a determinant is off by at most 8.1 units times the sum of the terms' sizes (the
// permanent), which is itself computed to 8.1 units. Twice that leaves room.
inline constexpr double kPlainDeterminantError = 16 * 0x1p-53;

// A vector product, and the sums of its terms' sizes.
struct SizedProduct {
  Vec3 value, size;
  SizedProduct(const Vec3& v, const Vec3& w) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      const double left = v[j] * w[k], right = v[k] * w[j];
      value[i] = left - right;
      size[i] = std::fabs(left) + std::fabs(right);
    }
  }
  // Of its product with u, if that is certain; else 0.
  int sign_with(const Vec3& u) const noexcept {
    const double determinant = u[0] * value[0] + u[1] * value[1] + u[2] * value[2];
    const double permanent = std::fabs(u[0]) * size[0] + std::fabs(u[1]) * size[1] + std::fabs(u[2]) * size[2];
    if (!(std::fabs(determinant) > kPlainDeterminantError * permanent)) return 0;
    return determinant > 0 ? 1 : -1;
  }
};

// orientation(a, b, c, d) of three points and any d.
class PlaneOrientation {
 public:
  explicit PlaneOrientation(const std::array<Vec3, 3>& points) noexcept
      : points_(points), normal_(difference(points[1], points[0]), difference(points[2], points[0])) {}
  int operator()(const Vec3& d) const noexcept {
    const int sign = normal_.sign_with(difference(points_[0], d));
    return sign != 0 ? sign : orientation(points_[0], points_[1], points_[2], d);
  }
  static Vec3 difference(const Vec3& a, const Vec3& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

 private:
  const std::array<Vec3, 3>& points_;
  SizedProduct normal_;
};

// orientation(p, q, c, d) of the ends of a segment and any two of three points.
class SegmentOrientation {
 public:
  SegmentOrientation(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& points) noexcept
      : p_(p), q_(q), points_(points), way_(PlaneOrientation::difference(p, q)) {
    for (std::size_t i = 0; i < 3; ++i) from_[i] = PlaneOrientation::difference(points[i], p);
  }
  int operator()(std::size_t c, std::size_t d) const noexcept {
    const int sign = SizedProduct(from_[c], from_[d]).sign_with(way_);
    return sign != 0 ? sign : orientation(p_, q_, points_[c], points_[d]);
  }

 private:
  const Vec3 &p_, &q_;
  const std::array<Vec3, 3>& points_;
  Vec3 way_;
  std::array<Vec3, 3> from_;
};

}  // namespace orchard::runtime::detail
