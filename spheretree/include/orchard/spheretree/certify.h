#pragma once
#include "orchard/covering/coverage.h"
#include "orchard/geometry/surface.h"
#include "orchard/runtime/packed_tree.h"

// Proves that a packed sphere-tree covers its surface.
namespace orchard {

// Returns the balls of a packed tree in the form that the boundary lemma uses: exactly the stored floats, relative to
// the tree's origin, in breadth-first order.
std::vector<PathBall> path_balls(const runtime::PackedSphereTree& tree);

// Proves the path rule for a packed tree against a surface. The result lists every triangle that is not proven to be
// covered, with witnesses relative to the tree's origin; balls are numbered in breadth-first order. The work is
// parallel over triangles; the result does not depend on the number of threads.
Coverage certify(const Surface& surface, const runtime::PackedSphereTree& tree, const Progress& progress = {});

}  // namespace orchard
