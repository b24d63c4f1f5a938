#pragma once
#include <vector>

#include "orchard/geometry/progress.h"
#include "surface_walk.h"

namespace orchard::detail {

// Spreads points evenly inside each cluster (dissertation 6.2.2). Neighbours repel each other linearly within a radius
// of twice the mean spacing. A boundary edge pushes the points that project onto it as evenly spread points beyond it
// would, plus `line_density` points per length on it. A point that would leave its cluster stops where its step meets
// the boundary. Clusters and points are independent within an iteration. O(n) per iteration.
void relax_in_clusters(const Surface& surface, const Clusters& clusters, double line_density, int iterations,
                       std::vector<SurfacePoint>& points, const Progress& progress);

}  // namespace orchard::detail
