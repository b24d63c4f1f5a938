#pragma once
#include <array>
#include <span>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Four points far apart: each the farthest from what those before it span.
std::array<Index, 4> spanning_points(std::span<const Point> points);

// Of what the points of a Frame span, exactly: 3 if they are found not to lie in a plane.
int affine_dimension(std::span<const Point> points);

}  // namespace orchard::detail
