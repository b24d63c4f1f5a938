#include "orchard/spheretree/tree.h"

#include <gtest/gtest.h>

#include <functional>

#include "orchard/geometry/error.h"
#include "orchard/spheretree/octree.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

TEST(SphereTree, ValidateFindsEachKindOfDamage) {
  const Surface surface(l_shape());
  const SphereTree good = octree(surface, {.depth = 2});
  ASSERT_NO_THROW(validate(good));
  const std::vector<std::function<void(SphereTree&)>> damages{
      [](SphereTree& t) { t.nodes.clear(); },
      [](SphereTree& t) { t.nodes[3].sphere.radius = 0; },
      [](SphereTree& t) { t.nodes[3].sphere.radius = -1; },
      [](SphereTree& t) { t.nodes[3].sphere.center.x() = std::nan(""); },
      [](SphereTree& t) { t.nodes[3].parent = 2; },
      [](SphereTree& t) { t.nodes[3].level = 2; },
      [](SphereTree& t) { t.nodes[0].child_count -= 1; },
      [](SphereTree& t) { t.nodes[1].first_child += 1; },
      [](SphereTree& t) { t.branching = 2; },
      [](SphereTree& t) { t.nodes.pop_back(); },
      [](SphereTree& t) { t.nodes[0].parent = 0; },
  };
  for (std::size_t i = 0; i < damages.size(); ++i) {
    SphereTree tree = good;
    damages[i](tree);
    EXPECT_THROW(validate(tree), Error) << "damage " << i;
  }
}

TEST(SphereTree, FiguresAreFractionsOfTheBoundingRadiusPerLevel) {
  SphereTree tree;
  tree.nodes.push_back({.sphere = {Point::Zero(), 1}, .first_child = 1, .child_count = 2, .inaccuracy = 4});
  tree.nodes.push_back({.sphere = {Point::Zero(), 1}, .parent = 0, .level = 1, .inaccuracy = 1});
  tree.nodes.push_back({.sphere = {Point::Zero(), 1}, .parent = 0, .level = 1, .inaccuracy = 2});
  const auto levels = level_figures(tree, 2);
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(levels[0].mean_inaccuracy, 2);
  EXPECT_EQ(levels[1].spheres, 2u);
  EXPECT_EQ(levels[1].mean_inaccuracy, 0.75);
  EXPECT_EQ(levels[1].max_inaccuracy, 1);
}

}  // namespace
}  // namespace orchard
