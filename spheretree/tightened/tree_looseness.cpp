#include "tree_looseness.h"

#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/outside_volume.h"
#include "orchard/spheretree/redundancy.h"

namespace orchard::detail {

std::vector<LevelLooseness> looseness_by_level(SphereTree tree, const Surface& surface) {
  remove_redundant(tree, surface);
  measure_inaccuracy(tree, surface);
  std::vector<LevelLooseness> levels;
  Index level = 0;
  for (const LevelFigures& figures : level_figures(tree, 1)) {
    std::vector<Sphere> spheres;
    for (const SphereNode& node : tree.nodes)
      if (node.level == level || (node.level < level && node.child_count == 0)) spheres.push_back(node.sphere);
    levels.push_back({figures.mean_inaccuracy, figures.max_inaccuracy, outside_volume(surface, spheres)});
    ++level;
  }
  return levels;
}

}  // namespace orchard::detail
