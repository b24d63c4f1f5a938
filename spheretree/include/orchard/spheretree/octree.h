#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

// Builds the sphere-tree of an octree, the simplest builder, with which others are compared.
namespace orchard {

// The options of octree().
struct OctreeOptions {
  Index depth = 3;  // The maximum number of levels below the root.
  Refinement refinement{};
  // The number of boxes per node, 2..64. If it is not 8, boxes are halved across their longest sides until there are
  // this many.
  Index branching = 8;
};

// Builds a tree from an octree over the bounding box of a surface: a ball around each octant that meets the surface,
// and the bounding ball of the mesh as root. Balls are larger than the octants need by tolerance::kCoverMargin, so the
// result is conservative. The surface need not be solid. Throws InputError for a branching out of range. Source:
// dissertation 5.2.
SphereTree octree(const Surface& surface, const OctreeOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
