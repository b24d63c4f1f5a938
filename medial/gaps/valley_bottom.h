#pragma once
#include <optional>

#include "orchard/geometry/sampling.h"

namespace orchard::detail {

// The bottom of a V, seen from the sample `cell`: the nearest vertex of the mesh that its own clusters share with the
// cluster of `triangle`, if that is within `reach`, or else the nearest point of the edges that they share. A vertex
// goes first because there a third side may close the V, and points would bounce into that corner. Nothing if the
// clusters do not adjoin. O(triangles of the cluster).
std::optional<ClosestPoint> bottom_of_valley(const Surface& surface, const SurfaceSampling& sampling, Index cell,
                                             Index triangle, double reach);

}  // namespace orchard::detail
