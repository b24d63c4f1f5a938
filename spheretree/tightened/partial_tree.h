#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/spheretree/tree.h"

namespace orchard::detail {

struct LevelNode {
  Sphere sphere;
  Index parent = kNone;  // on the level above
  bool leaf = false;     // needs no children
  bool grown = true;     // by the last growth (uncovered_regions.h)
};
using Level = std::vector<LevelNode>;

// A tree in the making, level by level, where parents may still change. Level 0 is the root, a ball around the surface.
class PartialTree {
 public:
  // The root holds the surface, whose bounding radius is given.
  PartialTree(const Sphere& root, double bounding_radius);

  std::size_t size() const { return levels_.size(); }
  Level& last() { return levels_.back(); }
  const Level& last() const { return levels_.back(); }
  std::span<const Level> levels() const { return levels_; }
  void add_level();
  // The levels down to this one, as they are: what is below may have grown them.
  PartialTree down_to(Index level) const;

  // Nodes of the level above the last that need children; the path regions of these are what balls may lie in.
  std::span<const Index> parents() const { return parents_; }
  // The balls from the root to each of them, without half of their last growth, or of what they leave around the
  // surface.
  std::vector<std::vector<Sphere>> paths() const;
  // The same of the nodes that are leaves already.
  std::vector<std::vector<Sphere>> leaf_paths() const;

  // A node above the last level that got no children, and was to have some, holds nothing that others do not: it is
  // left out.
  SphereTree tree() const;
  // The same, with each node's place in it; kNone: left out.
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
