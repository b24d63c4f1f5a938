#pragma once
#include <span>

#include "fit.h"

namespace orchard::detail {

struct ContractionOptions {
  SimplifiedBalls balls = SimplifiedBalls::free;  // what balls contractions make
  bool keeps_shape = false;                       // worse triangles and pinched sheets cost, too
};

// Contracts edges until no more than `target` vertices are left or no edge may be contracted, always that whose
// contraction costs the samples least: with the best common ball of the ends, how much larger the sum of the fourth
// powers of the distances gets, each to what becomes of its foot, and with what protrudes from the solid around the
// ends counted as so many samples. Where the link condition holds an edge, a few triangles of fins may be taken away
// first, if that costs less than any other contraction. The feet are followed, and walk to better ones around.
// Deterministic; parallel at its beginning.
void contract_by_samples(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples,
                         Assignment& feet, const ContractionOptions& options, Index target);

}  // namespace orchard::detail
