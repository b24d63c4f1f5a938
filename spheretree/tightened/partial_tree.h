#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/spheretree/tree.h"

namespace orchard::detail {

struct LevelNode {
  Sphere sphere;
  Index parent = kNone;  // the number of the parent on the level above
  bool leaf = false;     // whether it needs no children
  bool grown = true;     // whether the last growth (uncovered_regions.h) has been applied to it
};
using Level = std::vector<LevelNode>;

// A tree that is built level by level, in which parents may still change. Level 0 is the root, a ball around the
// surface.
class PartialTree {
 public:
  // The root contains the surface, whose bounding radius is given.
  PartialTree(const Sphere& root, double bounding_radius);

  std::size_t size() const { return levels_.size(); }
  Level& last() { return levels_.back(); }
  const Level& last() const { return levels_.back(); }
  std::span<const Level> levels() const { return levels_; }
  void add_level();
  // Returns the levels down to this one as they are now, including growth by later levels.
  PartialTree down_to(Index level) const;

  // The nodes of the level above the last that need children. Balls may lie in their path regions.
  std::span<const Index> parents() const { return parents_; }
  // Returns the balls from the root to each of these nodes, without half of their last growth, or of the margin that
  // they have around the surface.
  std::vector<std::vector<Sphere>> paths() const;
  // Returns the same for the nodes that are already leaves.
  std::vector<std::vector<Sphere>> leaf_paths() const;

  // Returns the tree. A node above the last level that was to get children but has none covers nothing that others do
  // not, and is left out.
  SphereTree tree() const;
  // Also returns the position of each node in the tree; kNone for those that are left out.
  SphereTree tree(std::vector<std::vector<Index>>& places) const;
  void take_spheres(const SphereTree& tree, const std::vector<std::vector<Index>>& places);

 private:
  std::vector<Sphere> path(std::size_t level, Index node) const;
  std::vector<std::vector<char>> kept() const;

  double radius_;
  std::vector<Level> levels_;
  std::vector<Index> parents_;
};

}  // namespace orchard::detail
