#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/medial/axis.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

struct MergeOptions {
  Index depth = 3;      // levels below the root
  Index branching = 8;  // children of a node at most, 2..64
  Refinement refinement{};
};

// Dissertation 6.3: the children of each node are the spheres of the medial vertices merged into it, merged pairwise
// along the medial axis by least cost until `branching` remain. The spheres hold the forming points, not yet the
// surface between them: cover() makes the tree conservative. Deterministic.
SphereTree merge_tree(const Surface& surface, const MedialAxis& axis, const MergeOptions& options = {},
                      const Progress& progress = {});

}  // namespace orchard
