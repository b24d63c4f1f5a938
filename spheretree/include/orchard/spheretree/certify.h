#pragma once
#include "orchard/covering/coverage.h"
#include "orchard/geometry/surface.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard {

// The balls of a packed tree as the boundary lemma takes them: exactly the floats that ship, relative to the tree's
// origin, in breadth-first order.
std::vector<PathBall> path_balls(const runtime::PackedSphereTree& tree);

// Proves the path rule for a packed tree against a surface. Lists every triangle that is not proven to be covered, with
// witnesses, which are relative to the tree's origin; balls are numbered in breadth-first order. Parallel over
// triangles; the result does not depend on the thread count.
Coverage certify(const Surface& surface, const runtime::PackedSphereTree& tree, const Progress& progress = {});

}  // namespace orchard
