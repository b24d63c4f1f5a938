#pragma once
#include <span>

#include "fit.h"

namespace orchard::detail {

struct ContractionOptions {
  SimplifiedBalls balls = SimplifiedBalls::free;  // the kind of ball that a contraction makes
  bool keeps_shape = false;                       // whether worse triangles and pinched sheets add to the cost
};

// Contracts edges, always the one that costs least, until at most `target` vertices are left or no edge may be
// contracted. The cost of a contraction, with the best common ball of the two ends, is by how much the sum of the
// fourth powers of the samples' distances from their feet grows, plus a term for balls around the ends that protrude
// from the solid, which count like samples. If the link condition forbids an edge, a few triangles of fins may be
// removed first, if that costs less than any other contraction. The feet of the samples are updated after each
// contraction: they move to better places nearby. Deterministic; parallel at its beginning.
void contract_by_samples(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples,
                         Assignment& feet, const ContractionOptions& options, Index target);

}  // namespace orchard::detail
