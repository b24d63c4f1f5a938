#pragma once
#include <cstdint>
#include <vector>

#include "orchard/medial/medial_mesh.h"
#include "reconstruction.h"

namespace orchard::detail {

// Points on the boundary of the reconstruction, spread at random over its area: of the spheres, the sides of the cones
// and the faces of the slabs that it is made of, those that lie in none of the others. `count` of them, or fewer where
// nearly all of these are inside others (kTries). Deterministic for a seed.
std::vector<Point> envelope_samples(const MedialMesh& mesh, const Reconstruction& reconstruction, Index count,
                                    std::uint64_t seed);

}  // namespace orchard::detail
