#pragma once
#include <span>
#include <vector>

#include "level_balls.h"
#include "partial_tree.h"

namespace orchard::detail {

// How tight a level is: mean and largest inaccuracy of its balls, in mesh units. 0: not measured.
struct LevelTightness {
  double mean = 0, max = 0;
};

// The inaccuracy of each ball of a level, in mesh units, as measure() has it, from above.
std::vector<double> inaccuracies(const Surface& surface, std::span<const LevelNode> level);
LevelTightness tightness(std::span<const double> values);

// The octree that a tree's levels are compared with: it says how loose a level may be, and gives starts and, where
// nothing else is tight enough, whole levels.
class OctreeReference {
 public:
  // spheres: how many each level of the tree may have.
  OctreeReference(const Surface& surface, std::span<const Index> spheres);

  const Sphere& root() const { return octree_.nodes[0].sphere; }
  // The least mean and the least maximum of the octree's levels below the root that have at most so many spheres;
  // infinite if there are none.
  LevelTightness bound(Index balls);
  // A tree's levels down to this one, the octree's own: for each, the deepest one that has room in it, so that a level
  // may repeat the one above.
  PartialTree levels(const PartialTree& root, Index level) const;
  // The octree's balls for a level of so many, each in the path region with room that holds most of its samples. They
  // are fewer if the octree's are; then the loosest balls are there twice, and one of the two is to go elsewhere.
  std::vector<LevelBall> start(const PathRegions& regions, Index balls, Index max_children) const;

 private:
  Index deepest_within(Index balls) const;
  std::span<const SphereNode> nodes(Index level) const;

  const Surface& surface_;
  std::vector<Index> spheres_;
  SphereTree octree_;
  std::vector<Index> begins_;             // of each level's nodes, and the end
  std::vector<LevelTightness> measured_;  // by level, as far as it was asked for
};

}  // namespace orchard::detail
