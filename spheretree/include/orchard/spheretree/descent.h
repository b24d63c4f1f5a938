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

// Random descent (dissertation 8.2), a post-process for a tree of any builder: balls are moved and shrunk at random,
// and a change is kept if the ball gets less loose (radius + signed distance of the centre) and the path rule still
// holds. No ball ever gets looser. A ball's steps shrink while its trials fail. Precondition: the tree is conservative,
// and so is what this leaves. Bounds and inaccuracies become stale: measure() afterwards. Throws InputError unless
// surface.solid().
DescentReport random_descent(SphereTree& tree, const Surface& surface, const DescentOptions& options = {},
                             const Progress& progress = {});

}  // namespace orchard
