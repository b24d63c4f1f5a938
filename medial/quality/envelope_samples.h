#pragma once
#include <cstdint>
#include <vector>

#include "orchard/medial/medial_mesh.h"
#include "reconstruction.h"

namespace orchard::detail {

// Returns points on the boundary of the reconstruction, chosen at random in proportion to area. They lie on the
// spheres, the sides of the cones and the faces of the slabs that the reconstruction consists of, and inside none of
// the others. There are `count` of them, or fewer if nearly all places are inside others (kTries). Deterministic for a
// seed.
std::vector<Point> envelope_samples(const MedialMesh& mesh, const Reconstruction& reconstruction, Index count,
                                    std::uint64_t seed);

}  // namespace orchard::detail
