#pragma once
#include <vector>

#include "orchard/geometry/surface.h"
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

// That of each level, as it is once redundant spheres are gone. Precondition: the tree is conservative.
std::vector<LevelLooseness> looseness_by_level(SphereTree tree, const Surface& surface);

}  // namespace orchard::detail
