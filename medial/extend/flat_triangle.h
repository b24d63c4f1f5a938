#pragma once
#include "orchard/geometry/mesh.h"

namespace orchard::detail {

inline constexpr double kFlat = 1e-4;  // the height of a flat triangle over its longest side

// Returns whether a triangle is flat. Precondition: ab is its longest side.
inline bool is_flat(const Point& a, const Point& b, const Point& c) {
  const Vector along = b - a;
  return along.cross(c - a).norm() <= kFlat * along.squaredNorm();
}

// Returns the same for three corners in any order.
inline bool is_flat_triangle(const Point& a, const Point& b, const Point& c) {
  const double ab = (b - a).squaredNorm(), ac = (c - a).squaredNorm(), bc = (c - b).squaredNorm();
  if (ab >= ac && ab >= bc) return is_flat(a, b, c);
  return ac >= bc ? is_flat(a, c, b) : is_flat(b, c, a);
}

}  // namespace orchard::detail
