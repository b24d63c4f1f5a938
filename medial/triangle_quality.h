#pragma once
#include <algorithm>
#include <numbers>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Returns how well a triangle is shaped: 6 / sqrt(3) times its area over half its perimeter and its longest edge. It is
// 1 for an equilateral triangle and 0 for one without area.
inline double triangle_quality(const Point& a, const Point& b, const Point& c) {
  const double x = (b - a).norm(), y = (c - b).norm(), z = (a - c).norm(), longest = std::max({x, y, z});
  if (!(longest > 0)) return 0;
  return 6 / std::numbers::sqrt3 * ((b - a).cross(c - a).norm() / 2) / ((x + y + z) / 2 * longest);
}

}  // namespace orchard::detail
