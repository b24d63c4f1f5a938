#pragma once
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/verify.h"

// Packs a sphere-tree so that all of its bounds are proven.
namespace orchard {

// A packed tree with the result of verify().
struct ProvenTree {
  runtime::PackedSphereTree packed;
  Verification proof;
  // The nodes that store a weaker bound than the measured one, because only the weaker one is proven; ascending.
  std::vector<Index> weakened;
};

// Packs and verifies a measured tree. If verify() does not prove a bound, a weaker bound that it can prove replaces it:
// for the signed distance of a centre, an upper bound on it; for a distance over a ball, whose search may have reached
// its work limit, the sum of the radius and the centre's distance, which needs no search. The nodes of `tree` are
// changed accordingly.
// In the result every bound is proven; what is not covered remains uncovered. Costs one verify(), and another one if a
// bound is replaced.
ProvenTree pack_proven(SphereTree& tree, const Surface& surface, const Progress& progress = {});

}  // namespace orchard
