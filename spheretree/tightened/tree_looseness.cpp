#include "tree_looseness.h"

#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/outside_volume.h"
#include "orchard/spheretree/redundancy.h"

namespace orchard::detail {

namespace {

SphereTree finished(const SphereTree& tree, const SphereTree& octree, const Surface& surface) {
  SphereTree finished = tree;
  const Index removed = remove_redundant(finished, surface).removed;
  measure_inaccuracy(finished, surface);
  if (removed == 0 || !is_loosened(finished, octree)) return finished;
  finished = tree;
  measure_inaccuracy(finished, surface);
  return finished;
}

}  // namespace

bool is_loosened(const SphereTree& tree, const SphereTree& octree) {
  if (octree.nodes.empty()) return false;
  const double tolerance = tolerance::kInaccuracy * octree.nodes[0].sphere.radius;
  const auto levels = level_figures(tree, 1), reference = level_figures(octree, 1);
  const auto is_looser = [&](const LevelFigures& level, const LevelFigures& other) {
    return level.mean_inaccuracy > other.mean_inaccuracy + tolerance;
  };
  for (std::size_t i = 1; i < levels.size(); ++i)
    if (is_looser(levels[i], levels[i - 1]) || (i < reference.size() && is_looser(levels[i], reference[i])))
      return true;
  return false;
}

std::vector<LevelLooseness> looseness_by_level(const SphereTree& tree, const SphereTree& octree,
                                               const Surface& surface) {
  const SphereTree shown = finished(tree, octree, surface);
  std::vector<LevelLooseness> levels;
  Index level = 0;
  for (const LevelFigures& figures : level_figures(shown, 1)) {
    std::vector<Sphere> spheres;
    for (const SphereNode& node : shown.nodes)
      if (node.level == level || (node.level < level && node.child_count == 0)) spheres.push_back(node.sphere);
    levels.push_back({figures.mean_inaccuracy, figures.max_inaccuracy, outside_volume(surface, spheres)});
    ++level;
  }
  return levels;
}

}  // namespace orchard::detail
