#pragma once
#include <span>

#include "orchard/geometry/sampling.h"

namespace orchard::detail {

// Whether some triangle of `from` is connected to triangles at both points by a chain of triangles whose common edges
// touch the ball. Then all of them lie on one connected part of the surface inside the ball. O(triangles in the ball).
bool joined_inside(const Surface& surface, const SurfaceSampling& sampling, const Sphere& ball,
                   std::span<const Index> from, std::array<Index, 2> points);

}  // namespace orchard::detail
