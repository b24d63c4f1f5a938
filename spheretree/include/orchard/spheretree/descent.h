#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/tree.h"

// Tightens a finished sphere-tree by random descent.
namespace orchard {

// The options of random_descent().
struct DescentOptions {
  Index trials_per_node = 200;  // The number of random changes of each ball. More trials give tighter balls.
  std::uint64_t seed = 1;
};

// The result of random_descent().
struct DescentReport {
  std::uint64_t trials = 0, accepted = 0;
  // The mean over the nodes of radius + signed distance of the centre, as fractions of R.
  double looseness_before = 0, looseness_after = 0;
};

// Makes a tree of any builder tighter. Balls are moved and shrunk at random. The looseness of a ball is its radius plus
// the signed distance of its centre; a change is kept if it lowers the looseness and the path rule still holds. The
// steps of a ball become shorter while its trials fail.
// Precondition: the tree is conservative; it remains so. Bounds and inaccuracies become stale: call measure()
// afterwards. Throws InputError unless surface.solid(). Each trial costs one query of the signed distance and one local
// check of the path rule. Source: dissertation 8.2.
DescentReport random_descent(SphereTree& tree, const Surface& surface, const DescentOptions& options = {},
                             const Progress& progress = {});

}  // namespace orchard
