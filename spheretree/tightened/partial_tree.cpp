#include "partial_tree.h"

#include <algorithm>

#include "orchard/geometry/tolerance.h"
#include "uncovered_regions.h"

namespace orchard::detail {

PartialTree::PartialTree(const Sphere& root, double bounding_radius) : radius_(bounding_radius) {
  levels_.push_back({{{root.center, root.radius + tolerance::kCoverMargin * radius_}}});
}

void PartialTree::add_level() {
  parents_.clear();
  for (Index i = 0; i < levels_.back().size(); ++i)
    if (!levels_.back()[i].leaf) parents_.push_back(i);
  levels_.emplace_back();
}

PartialTree PartialTree::down_to(Index level) const {
  PartialTree upper = *this;
  upper.levels_.resize(level + 1);
  upper.parents_.clear();
  return upper;
}

std::vector<std::vector<Sphere>> PartialTree::paths() const {
  std::vector<std::vector<Sphere>> result;
  for (Index parent : parents_) result.push_back(path(levels_.size() - 2, parent));
  return result;
}

std::vector<Sphere> PartialTree::path(std::size_t level, Index node) const {
  std::vector<Sphere> balls;
  for (;; --level) {
    const LevelNode& n = levels_[level][node];
    const double room = level == 0 ? 0 : n.grown ? kLastGrowth : tolerance::kCoverMargin;
    balls.push_back({n.sphere.center, n.sphere.radius - room / 2 * radius_});
    if (level == 0) break;
    node = n.parent;
  }
  std::reverse(balls.begin(), balls.end());
  return balls;
}

std::vector<std::vector<Sphere>> PartialTree::leaf_paths() const {
  std::vector<std::vector<Sphere>> result;
  for (std::size_t level = 0; level < levels_.size(); ++level)
    for (Index i = 0; i < levels_[level].size(); ++i)
      if (levels_[level][i].leaf) result.push_back(path(level, i));
  return result;
}

std::vector<std::vector<char>> PartialTree::kept() const {
  std::vector<std::vector<char>> kept(levels_.size());
  for (std::size_t level = levels_.size(); level-- > 0;) {
    const bool last = level + 1 == levels_.size();
    for (const LevelNode& node : levels_[level]) kept[level].push_back(last || node.leaf);
    if (last) continue;
    for (Index i = 0; i < levels_[level + 1].size(); ++i)
      if (kept[level + 1][i]) kept[level][levels_[level + 1][i].parent] = 1;
  }
  return kept;
}

SphereTree PartialTree::tree() const {
  std::vector<std::vector<Index>> places;
  return tree(places);
}

SphereTree PartialTree::tree(std::vector<std::vector<Index>>& places) const {
  const auto kept = this->kept();
  places.clear();
  for (const Level& level : levels_) places.emplace_back(level.size(), kNone);
  SphereTree result;
  result.branching = 0;
  result.nodes.push_back({.sphere = levels_[0][0].sphere});
  places[0][0] = 0;
  std::vector<Index> row{0};  // the nodes of the level, in the tree's order
  for (std::size_t level = 0; level + 1 < levels_.size(); ++level) {
    std::vector<std::vector<Index>> children(levels_[level].size());
    for (Index i = 0; i < levels_[level + 1].size(); ++i)
      if (kept[level + 1][i]) children[levels_[level + 1][i].parent].push_back(i);
    std::vector<Index> next;
    for (Index i : row) {
      if (children[i].empty()) continue;
      const Index at = places[level][i];
      result.nodes[at].first_child = static_cast<Index>(result.nodes.size());
      result.nodes[at].child_count = static_cast<Index>(children[i].size());
      result.branching = std::max(result.branching, result.nodes[at].child_count);
      for (Index child : children[i]) {
        places[level + 1][child] = static_cast<Index>(result.nodes.size());
        result.nodes.push_back(
            {.sphere = levels_[level + 1][child].sphere, .parent = at, .level = static_cast<Index>(level + 1)});
        next.push_back(child);
      }
    }
    row = std::move(next);
  }
  return result;
}

void PartialTree::take_spheres(const SphereTree& tree, const std::vector<std::vector<Index>>& places) {
  for (std::size_t level = 0; level < levels_.size(); ++level)
    for (Index i = 0; i < levels_[level].size(); ++i)
      if (places[level][i] != kNone) levels_[level][i].sphere = tree.nodes[places[level][i]].sphere;
}

}  // namespace orchard::detail
