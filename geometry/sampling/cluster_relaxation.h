#pragma once
#include <vector>

#include "orchard/geometry/progress.h"
#include "surface_walk.h"

namespace orchard::detail {

// Evens out points inside each cluster (dissertation 6.2.2): neighbours repel linearly within a radius of twice the
// mean spacing, and a boundary edge pushes what projects on it like an even spread of points beyond it, plus
// `line_density` points per length on it. A point that would leave its cluster stops where its step meets the boundary.
// Clusters and points are independent within an iteration. O(n) per iteration.
void relax_in_clusters(const Surface& surface, const Clusters& clusters, double line_density, int iterations,
                       std::vector<SurfacePoint>& points, const Progress& progress);

}  // namespace orchard::detail
