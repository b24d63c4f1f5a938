#pragma once
#include <span>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Returns the point that is farthest from a place, and the first one if several are. Precondition: there is a point.
// O(n).
inline Index farthest_from(const Point& place, std::span<const Point> points) {
  Index farthest = 0;
  double max = -1;
  for (Index i = 0; i < points.size(); ++i) {
    const double squared = (points[i] - place).squaredNorm();
    if (squared > max) farthest = i, max = squared;
  }
  return farthest;
}

}  // namespace orchard::detail
