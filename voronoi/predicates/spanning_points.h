#pragma once
#include <array>
#include <span>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Four points far apart: each is the farthest from the point, line or plane through those before it.
std::array<Index, 4> spanning_points(std::span<const Point> points);

// The exact dimension of what the points of a Frame span: 3 if they do not lie in a plane.
int affine_dimension(std::span<const Point> points);

}  // namespace orchard::detail
