#pragma once
#include <optional>

#include "orchard/geometry/sampling.h"

namespace orchard::detail {

// Returns the bottom of a V, seen from the sample `cell`: the nearest vertex of the mesh that the clusters of the
// sample share with the cluster of `triangle`, if it is within `reach`; otherwise the nearest point of the edges that
// they share. A vertex has priority because a third side may close the V there, and repair points would move into that
// corner again and again. Returns nullopt if the clusters are not adjacent. O(triangles of the cluster).
std::optional<ClosestPoint> bottom_of_valley(const Surface& surface, const SurfaceSampling& sampling, Index cell,
                                             Index triangle, double reach);

}  // namespace orchard::detail
