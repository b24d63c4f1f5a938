#pragma once
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/verify.h"

namespace orchard {

// A tree as it ships, with what verify() says of it.
struct ProvenTree {
  runtime::PackedSphereTree packed;
  Verification proof;
  // The nodes with a bound that was not proven as measured, so that a weaker one ships; ascending.
  std::vector<Index> weakened;
};

// Packs and verifies a measured tree. A bound that verify() does not prove is replaced by a weaker one that it can
// prove: a centre's signed distance by an upper bound on it; a distance over a ball, for which the search may have run
// out of work, by the sum of the radius and the centre's distance, which needs no search. The nodes of `tree` are
// changed accordingly. Afterwards every bound is proven; what is not covered stays uncovered. Costs one verify(), and
// another one where a bound is replaced.
ProvenTree pack_proven(SphereTree& tree, const Surface& surface, const Progress& progress = {});

}  // namespace orchard
