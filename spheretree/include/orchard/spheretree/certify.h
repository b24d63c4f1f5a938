#pragma once
#include "orchard/covering/coverage.h"
#include "orchard/geometry/surface.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard {

// The balls of a packed tree, exactly the floats that ship, as the boundary lemma takes them.
std::vector<PathBall> path_balls(const runtime::PackedSphereTree& tree);

// Proves the path rule for a packed tree against a surface. What is not proven is listed with witnesses; balls are
// numbered in the packed tree's breadth-first order.
Coverage certify(const Surface& surface, const runtime::PackedSphereTree& tree, const Progress& progress = {});

}  // namespace orchard
