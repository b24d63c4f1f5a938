#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

struct OctreeOptions {
  Index depth = 3;  // levels below the root at most
  Refinement refinement{};
  Index branching = 8;  // 2..64; not 8: boxes are halved across their longest sides until there are so many
};

// Dissertation 5.2: an octree over the smallest isothetic box, a ball around each octant that meets the surface, and
// the mesh's bounding ball as root; balls are wider than the octants by tolerance::kCoverMargin. Any surface.
// Throws InputError for a branching out of range.
SphereTree octree(const Surface& surface, const OctreeOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
