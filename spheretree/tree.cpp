#include "orchard/spheretree/tree.h"

#include <algorithm>
#include <cmath>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

void require(bool holds, Index node, const char* what) {
  if (!holds) throw Error("sphere-tree: node " + std::to_string(node) + " " + what);
}

void validate_node(const SphereTree& tree, Index i, Index& expected_child) {
  const SphereNode& node = tree.nodes[i];
  require(node.sphere.center.allFinite() && std::isfinite(node.sphere.radius), i, "is not finite");
  require(node.sphere.radius > 0, i, "has no positive radius");
  require(node.child_count <= tree.branching, i, "has more children than the tree's branching");
  if (node.child_count == 0) return;
  require(node.first_child == expected_child, i, "breaks the breadth-first order of children");
  require(node.child_count <= tree.nodes.size() - expected_child, i, "has children beyond the end");
  for (Index child = expected_child; child < expected_child + node.child_count; ++child) {
    require(tree.nodes[child].parent == i, child, "names another parent than the one that owns it");
    require(tree.nodes[child].level == node.level + 1, child, "is not one level below its parent");
  }
  expected_child += node.child_count;
}

}  // namespace

void validate(const SphereTree& tree) {
  if (tree.nodes.empty()) throw Error("the sphere-tree has no root");
  require(tree.nodes[0].parent == kNone && tree.nodes[0].level == 0, 0, "is no root");
  Index expected_child = 1;
  for (Index i = 0; i < tree.nodes.size(); ++i) validate_node(tree, i, expected_child);
  if (expected_child != tree.nodes.size()) throw Error("the sphere-tree has nodes without a parent");
}

std::vector<PathBall> path_balls(const SphereTree& tree) {
  std::vector<PathBall> balls;
  balls.reserve(tree.nodes.size());
  for (const SphereNode& node : tree.nodes)
    balls.push_back({node.sphere.center, node.sphere.radius, node.parent, node.child_count == 0});
  return balls;
}

std::vector<PathBall> path_balls(std::span<const Sphere> balls, const Point& origin) {
  std::vector<PathBall> result;
  result.reserve(balls.size());
  for (const Sphere& ball : balls) result.push_back({ball.center - origin, ball.radius, kNone, true});
  return result;
}

std::vector<LevelFigures> level_figures(const SphereTree& tree, double bounding_radius) {
  std::vector<LevelFigures> levels(tree.nodes.empty() ? 0 : tree.depth() + 1);
  for (const SphereNode& node : tree.nodes) {
    LevelFigures& level = levels[node.level];
    ++level.spheres;
    level.mean_inaccuracy += node.inaccuracy / bounding_radius;
    level.max_inaccuracy = std::max(level.max_inaccuracy, node.inaccuracy / bounding_radius);
  }
  for (LevelFigures& level : levels) level.mean_inaccuracy /= level.spheres;
  return levels;
}

double overall_inaccuracy(const SphereTree& tree) {
  const std::vector<LevelFigures> levels = level_figures(tree, 1);
  double sum = 0;
  for (std::size_t i = 1; i < levels.size(); ++i)
    sum += std::log(levels[i].mean_inaccuracy) + std::log(levels[i].max_inaccuracy);
  return levels.size() < 2 ? 0 : std::exp(sum / static_cast<double>(2 * (levels.size() - 1)));
}

}  // namespace orchard
