#pragma once
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/verify.h"

namespace orchard {

// A tree as it ships, with what verify() says of it.
struct ProvenTree {
  runtime::PackedSphereTree packed;
  Verification proof;
  std::vector<Index>
      weakened;  // nodes with a bound that was not proven as measured, so that a weaker one ships; ascending
};

// Packs and verifies a measured tree. A bound that verify() does not prove gives way to the one that it can: a centre's
// signed distance to what it is at most; a distance over a ball, for which the search may have run out of work, to the
// sum of the radius and the centre's distance, which needs no search. The tree's nodes are changed accordingly. Bounds
// are proven then; what is not covered stays so. Costs a verify(), and another one where a bound gives way.
ProvenTree pack_proven(SphereTree& tree, const Surface& surface, const Progress& progress = {});

}  // namespace orchard
