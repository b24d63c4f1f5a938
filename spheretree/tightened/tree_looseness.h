#pragma once
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard::detail {

// What a level is compared by: its spheres' inaccuracy, in mesh units, and the volume outside that it has with the
// leaves above it.
struct LevelLooseness {
  double mean = 0, max = 0, outside_volume = 0;
  bool is_within(const LevelLooseness& other) const {
    return mean <= other.mean && max <= other.max && outside_volume <= other.outside_volume;
  }
  double product() const { return mean * max * outside_volume; }
};

// Whether a tree that is refined so goes on everywhere down to its depth.
inline bool goes_on_everywhere(const Refinement& refinement) {
  return refinement.error <= 0 && refinement.regions.empty();
}

// Whether removing redundant spheres has made a level looser in the mean than the one above it, or than the octree's:
// tight spheres can be redundant. Such a tree keeps its redundant spheres. An octree without nodes stands for trees
// that are not compared, since they do not go on everywhere down to their depth. Precondition: both trees are measured.
bool is_loosened(const SphereTree& tree, const SphereTree& octree);

// That of each level, as it is in the finished tree: without redundant spheres, unless it is_loosened() by that.
// Precondition: the tree is conservative, the octree measured.
std::vector<LevelLooseness> looseness_by_level(const SphereTree& tree, const SphereTree& octree,
                                               const Surface& surface);

}  // namespace orchard::detail
