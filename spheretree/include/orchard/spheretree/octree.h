#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

struct OctreeOptions {
  Index depth = 3;  // levels below the root at most
  Refinement refinement{};
  Index branching = 8;  // 2..64; other than 8: boxes are halved across their longest sides until there are so many
};

// Builds a tree from an octree over the surface's bounding box: a ball around each octant that meets the surface, and
// the mesh's bounding ball as root. Balls are larger than the octants need by tolerance::kCoverMargin, so the result is
// conservative. Any surface will do, solid or not. Throws InputError for a branching out of range. Source: dissertation
// 5.2.
SphereTree octree(const Surface& surface, const OctreeOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
