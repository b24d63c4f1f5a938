#pragma once
#include "orchard/geometry/sampling.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// Places of a surface that are farther than `limit` (mesh units) from every ball of a medial mesh, found among random
// ones, four for each point of `sampling`: as repair points, none closer to another, or to a point of `sampling`, than
// a tenth of the mean spacing. Deterministic; parallel. O(n log n).
SurfaceSampling open_places(const Surface& surface, const MedialMesh& mesh, const SurfaceSampling& sampling,
                            double limit);

}  // namespace orchard::detail
