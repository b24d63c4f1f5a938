#pragma once
#include <algorithm>
#include <limits>

#include "orchard/geometry/surface.h"

namespace orchard::test {

// The distance to the nearest of all triangles: no tree, no shortcut.
inline double brute_distance(const Surface& surface, const Point& query) {
  double min = std::numeric_limits<double>::infinity();
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    min = std::min(min, closest_point_of_triangle(query, a, b, c).distance);
  }
  return min;
}

}  // namespace orchard::test
