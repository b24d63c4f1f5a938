#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

struct DescentOptions {
  Index trials_per_node = 200;
  std::uint64_t seed = 1;
};

struct DescentReport {
  std::uint64_t trials = 0, accepted = 0;
  double looseness_before = 0, looseness_after = 0;  // mean over the nodes, as fractions of R
};

// Makes a tree of any builder tighter by random descent: balls are moved and shrunk at random, and a change is kept if
// the ball gets less loose (radius + signed distance of the centre) and the path rule still holds. No ball ever gets
// looser. A ball's steps shrink while its trials fail. Precondition: the tree is conservative; it stays so. Bounds and
// inaccuracies become stale: call measure() afterwards. Throws InputError unless surface.solid(). Costs one query of
// the signed distance and one local check of the path rule for each trial. Source: dissertation 8.2.
DescentReport random_descent(SphereTree& tree, const Surface& surface, const DescentOptions& options = {},
                             const Progress& progress = {});

}  // namespace orchard
