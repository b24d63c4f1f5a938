#pragma once
#include <span>
#include <vector>

#include "level_balls.h"
#include "partial_tree.h"

namespace orchard::detail {

// The tightness of a level: the mean and the largest inaccuracy of its balls, in mesh units; 0 if it was not measured.
struct LevelTightness {
  double mean = 0, max = 0;
};

// Returns an upper bound on the inaccuracy of each ball of a level, as measure() computes it, in mesh units.
std::vector<double> inaccuracies(const Surface& surface, std::span<const LevelNode> level);
LevelTightness tightness(std::span<const double> values);

// The octree with which the levels of a tree are compared. It gives a limit for how loose a level may be, and starts,
// and whole levels where no other method is tight enough.
class OctreeReference {
 public:
  // `spheres` has the maximum number of spheres of each level of the tree.
  OctreeReference(const Surface& surface, std::span<const Index> spheres);

  const Sphere& root() const { return octree_.nodes[0].sphere; }
  // Returns the smallest mean and the smallest maximum of the octree's levels below the root that have at most `balls`
  // spheres; infinity if there are none.
  LevelTightness bound(Index balls);
  // Returns the octree's own levels for those of a tree down to this one. Each is the deepest one that has room there,
  // so a level may repeat the one above.
  PartialTree levels(const PartialTree& root, Index level) const;
  // Returns the octree's balls for a level of `balls` spheres, each in the path region with room that contains most of
  // its samples. If the octree has fewer, the loosest balls are repeated, and one of the two copies should be moved
  // elsewhere.
  std::vector<LevelBall> start(const PathRegions& regions, Index balls, Index max_children) const;

 private:
  Index deepest_within(Index balls) const;
  std::span<const SphereNode> nodes(Index level) const;

  const Surface& surface_;
  std::vector<Index> spheres_;
  SphereTree octree_;
  std::vector<Index> begins_;             // where the nodes of each level begin, and the end of the last
  std::vector<LevelTightness> measured_;  // the levels that have been measured so far
};

}  // namespace orchard::detail
