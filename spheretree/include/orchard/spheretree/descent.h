#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/tree.h"

// Tightens a finished sphere-tree by random descent.
namespace orchard {

// The options of random_descent().
struct DescentOptions {
  Index trials_per_node = 200;
  std::uint64_t seed = 1;
};

// The result of random_descent().
struct DescentReport {
  std::uint64_t trials = 0, accepted = 0;
  // The mean over the nodes of radius + signed distance of the centre, as fractions of R.
  double looseness_before = 0, looseness_after = 0;
};

// Makes a tree of any builder tighter: balls are moved and shrunk at random, and a change is kept if the ball gets less
// loose (radius + signed distance of the centre) and the path rule still holds. No ball ever gets looser. The steps of
// a ball shrink while its trials fail.
// Precondition: the tree is conservative; it remains so. Bounds and inaccuracies become stale: call measure()
// afterwards. Throws InputError unless surface.solid(). Each trial costs one query of the signed distance and one local
// check of the path rule. Source: dissertation 8.2.
DescentReport random_descent(SphereTree& tree, const Surface& surface, const DescentOptions& options = {},
                             const Progress& progress = {});

}  // namespace orchard
