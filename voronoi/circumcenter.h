#pragma once
#include <cmath>
#include <limits>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Half a unit in the last place: the relative error of one rounding.
inline constexpr double kRounding = std::numeric_limits<double>::epsilon() / 2;

// The circumcentre of the origin and three points a, b, c, with what is needed to judge it. Taking one of the forming
// points as the origin keeps the error proportional to the tetrahedron and not to its distance from the world's origin.
struct RelativeCenter {
  Vector center;     // meaningless where !reliable(): divided by a determinant that is only round-off
  double volume6;    // a . (b x c): six times the signed volume
  double condition;  // |a||b||c| / |volume6| >= 1: round-off is magnified this many times

  bool reliable() const { return condition < 0x1p45; }
};

inline RelativeCenter circumcenter_from_origin(const Vector& a, const Vector& b, const Vector& c) {
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), cc = c.squaredNorm();
  const Vector b_cross_c = b.cross(c);
  const double volume6 = a.dot(b_cross_c);
  const Vector numerator = aa * b_cross_c + bb * c.cross(a) + cc * a.cross(b);
  return {numerator * (0.5 / volume6), volume6, std::sqrt(aa) * std::sqrt(bb) * std::sqrt(cc) / std::abs(volume6)};
}

}  // namespace orchard::detail
