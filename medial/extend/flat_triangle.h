#pragma once
#include "orchard/geometry/mesh.h"

namespace orchard::detail {

inline constexpr double kFlat = 1e-4;  // of its longest side: the height of a flat triangle

// Whether a triangle is flat of which ab is the longest side.
inline bool is_flat(const Point& a, const Point& b, const Point& c) {
  const Vector along = b - a;
  return along.cross(c - a).norm() <= kFlat * along.squaredNorm();
}

// The same for three corners in any order.
inline bool is_flat_triangle(const Point& a, const Point& b, const Point& c) {
  const double ab = (b - a).squaredNorm(), ac = (c - a).squaredNorm(), bc = (c - b).squaredNorm();
  if (ab >= ac && ab >= bc) return is_flat(a, b, c);
  return ac >= bc ? is_flat(a, c, b) : is_flat(b, c, a);
}

}  // namespace orchard::detail
