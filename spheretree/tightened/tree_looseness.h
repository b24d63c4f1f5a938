#pragma once
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard::detail {

// By what a level is compared: the inaccuracy of its spheres, in mesh units, and the volume outside that it has
// together with the leaves above it.
struct LevelLooseness {
  double mean = 0, max = 0, outside_volume = 0;
  bool is_within(const LevelLooseness& other) const {
    return mean <= other.mean && max <= other.max && outside_volume <= other.outside_volume;
  }
  double product() const { return mean * max * outside_volume; }
};

// Whether a tree with this refinement is refined everywhere down to its depth.
inline bool goes_on_everywhere(const Refinement& refinement) {
  return refinement.error <= 0 && refinement.regions.empty();
}

// Whether removing redundant spheres has made the mean of a level looser than that of the level above it or of the
// octree. That happens because tight spheres can be redundant. Such a tree keeps its redundant spheres. An octree
// without nodes means that the tree is not compared, because it is not refined everywhere. Precondition: both trees are
// measured.
bool is_loosened(const SphereTree& tree, const SphereTree& octree);

// Returns the looseness of each level of the finished tree: without redundant spheres, unless is_loosened() by removing
// them. Precondition: the tree is conservative, and the octree is measured.
std::vector<LevelLooseness> looseness_by_level(const SphereTree& tree, const SphereTree& octree,
                                               const Surface& surface);

}  // namespace orchard::detail
