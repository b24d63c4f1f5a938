// Triangulation of one flat polygon that may have holes.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "vec3.h"

namespace orchard::models {

using IndexTriangle = std::array<std::size_t, 3>;

/// Triangles over `points`, counter-clockwise. `rings` lists the boundary polygons by point index:
/// the outer one and the holes, in any order and direction, every point in exactly one ring. The
/// result is a Delaunay triangulation as far as the boundary allows, so thin triangles are rare.
/// Choices between near-equal candidates do not depend on the last bits of the coordinates.
[[nodiscard]] std::vector<IndexTriangle> triangulate_polygon(const std::vector<Vec2>& points,
                                                             const std::vector<std::vector<std::size_t>>& rings);

}  // namespace orchard::models
