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

// Packs and verifies a measured tree. If verify() does not prove a bound, it is replaced by a weaker bound that
// verify() can prove. For the signed distance of a centre, this is an upper bound on it. For a distance over a ball,
// which verify() cannot prove if its search reaches the work limit, this is the radius plus the distance of the centre,
// which needs no search. The nodes of `tree` are changed accordingly. In the result every bound is proven, but
// triangles that the tree does not cover remain uncovered. Costs one verify(), and another one if a bound is replaced.
ProvenTree pack_proven(SphereTree& tree, const Surface& surface, const Progress& progress = {});

}  // namespace orchard
