#pragma once
#include <vector>

#include "cell_patches.h"
#include "orchard/geometry/sampling.h"

namespace orchard::detail {

// Whether some triangle of `from` is joined to triangles at both points by a chain of triangles whose common edges
// touch the ball: then they lie on one connected part of the surface inside the ball. O(triangles in the ball).
bool joined_inside(const Surface& surface, const SurfaceSampling& sampling, const Sphere& ball,
                   std::span<const Index> from, std::array<Index, 2> points);

// The cells whose faces with patch.cell cross the surface along the border of `patch` harmfully, ascending: those for
// which the patch is not joined to both points inside the ball around their middle, `joined_radius` times their
// distance.
std::vector<Index> harmful_neighbors(const Surface& surface, const SurfaceSampling& sampling,
                                     const RestrictedVoronoi& restricted, const CellPatch& patch, double joined_radius);

}  // namespace orchard::detail
