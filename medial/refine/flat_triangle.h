#pragma once
#include "orchard/geometry/mesh.h"

namespace orchard::detail {

inline constexpr double kFlat = 1e-4;  // of its longest side: the height of a flat triangle

// Whether a triangle is flat of which ab is the longest side.
inline bool is_flat(const Point& a, const Point& b, const Point& c) {
  const Vector along = b - a;
  return along.cross(c - a).norm() <= kFlat * along.squaredNorm();
}

}  // namespace orchard::detail
