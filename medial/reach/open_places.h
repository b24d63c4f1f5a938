#pragma once
#include "orchard/geometry/sampling.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// Finds places of a surface that are farther than `limit` (mesh units) from every ball of a medial mesh, among random
// places of which there are four for each point of `sampling`. Returns them as repair points, at least a tenth of the
// mean spacing apart from each other and from the points of `sampling`. Deterministic; parallel. O(n log n).
SurfaceSampling open_places(const Surface& surface, const MedialMesh& mesh, const SurfaceSampling& sampling,
                            double limit);

}  // namespace orchard::detail
