#include "orchard/spheretree/cover.h"

#include <gtest/gtest.h>

#include "orchard/spheretree/octree.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

TEST(Cover, LeavesACoveredTreeAlone) {
  const Surface surface(torus(24, 12));
  const SphereTree before = octree(surface);
  SphereTree after = before;
  const CoverReport report = cover(after, surface);
  EXPECT_EQ(report.rounds, 0);
  EXPECT_TRUE(same_tree(before, after));
}

TEST(Cover, RepairsRandomlyShrunkenTreesByTheLeastOfGrowth) {
  const Surface surface(u_shape(0.3));
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Random random(seed, 1);
    SphereTree tree = octree(surface, {.depth = 3});
    const SphereTree before = tree;
    double shrunk = 0;
    for (SphereNode& node : tree.nodes) {
      const double by = random.uniform(0, 0.3) * node.sphere.radius;
      node.sphere.radius -= by;
      shrunk = std::max(shrunk, by);
    }
    const SphereTree damaged = tree;
    const CoverReport report = cover(tree, surface);
    EXPECT_TRUE(surface_coverage(surface, path_balls(tree)).complete()) << "seed " << seed;
    EXPECT_GT(report.rounds, 0) << "seed " << seed;
    EXPECT_LE(report.max_growth * surface.bounding_radius(), 1.5 * shrunk) << "seed " << seed;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i)
      EXPECT_GE(tree.nodes[i].sphere.radius, damaged.nodes[i].sphere.radius) << "seed " << seed;
  }
}

TEST(Cover, GrowsAPathToATriangleThatNoSphereTouches) {
  const Surface surface(two_boxes(5));
  SphereTree tree;
  tree.nodes.push_back({.sphere = {Point(0.5, 0.5, 0.5), 0.1}, .first_child = 1, .child_count = 1});
  tree.nodes.push_back({.sphere = {Point(0.5, 0.5, 0.5), 0.1}, .parent = 0, .level = 1});
  cover(tree, surface);
  for (const Point& point : points_on(surface, 20, 2)) ASSERT_TRUE(has_path(tree, point));
}

}  // namespace
}  // namespace orchard
