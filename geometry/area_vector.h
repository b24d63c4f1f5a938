#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {

// Twice the area vector of a triangle whose corners are multiplied by `scale`. It is computed from the two shortest
// edges, because the rounding error is least there. Zero if it would be nothing but rounding error: the triangle is
// then degenerate.
inline Vector area_vector(const std::array<Point, 3>& p, double scale) {
  std::array<Vector, 3> edges;  // opposite the corners
  std::array<double, 3> lengths{};
  std::size_t apex = 0;  // opposite the longest edge
  for (std::size_t i = 0; i < 3; ++i) {
    edges[i] = (p[(i + 2) % 3] - p[(i + 1) % 3]) * scale;
    lengths[i] = edges[i].norm();
    if (lengths[i] > lengths[apex]) apex = i;
  }
  const std::size_t b = (apex + 1) % 3, c = (apex + 2) % 3;
  const Vector cross = edges[b].cross(edges[c]);
  return cross.norm() <= tolerance::kNoArea * lengths[b] * lengths[c] ? Vector::Zero() : cross;
}

// A power of two that brings a box of this size near one, so that products of lengths neither vanish nor overflow.
inline double unit_scale(const Box& box) {
  const double size = box.isEmpty() ? 0 : (box.max() / 2 - box.min() / 2).maxCoeff();
  return size > 0 ? std::ldexp(1.0, -std::clamp(std::ilogb(size), -1000, 1000)) : 1;
}

}  // namespace orchard
