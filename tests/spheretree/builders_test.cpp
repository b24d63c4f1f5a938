#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "orchard/geometry/error.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/octree.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

TEST(Octree, CoversEveryShapeAsBuilt) {
  for (const Shape& shape : shapes()) {
    const Surface surface(shape.mesh);
    for (const Index depth : {1u, 2u, 4u}) {
      const SphereTree tree = octree(surface, {.depth = depth});
      EXPECT_EQ(tree.depth(), depth) << shape.name;
      expect_conservative(tree, surface, shape.name);
    }
  }
}

TEST(Octree, HalvesBoxesForAnyBranching) {
  const Surface surface(u_shape(0.3));
  for (const Index branching : {2u, 3u, 12u, 64u}) {
    const SphereTree tree = octree(surface, {.depth = 2, .branching = branching});
    EXPECT_EQ(tree.nodes[0].child_count, branching);
    expect_conservative(tree, surface, "U");
  }
  EXPECT_THROW(octree(surface, {.branching = 1}), InputError);
  EXPECT_THROW(octree(surface, {.branching = 65}), InputError);
}

TEST(Octree, TakesASurfaceThatIsNotClosed) {
  const Surface surface(open_box());
  expect_conservative(octree(surface, {.depth = 3}), surface, "open box");
}

TEST(Octree, HalvesTheRadiusWithEveryLevel) {
  const Surface surface(torus(24, 12));
  const SphereTree tree = octree(surface, {.depth = 4});
  const double first = surface.bounding_box().diagonal().norm() / 4;
  for (const SphereNode& node : tree.nodes)
    if (node.level > 0) {
      const double expected = first / (1 << (node.level - 1));
      EXPECT_NEAR(node.sphere.radius, expected, 1e-6 * first);
    }
}

TEST(MergeTree, HoldsItsFormingPointsOnSomePathBeforeAnythingIsGrown) {
  for (const Shape& shape : shapes()) {
    const Surface surface(shape.mesh);
    const MedialAxis axis = axis_of(surface);
    const SphereTree tree = merge_tree(surface, axis, {.closing = MergeClosing::growth}).tree;
    ASSERT_NO_THROW(validate(tree)) << shape.name;
    for (Index i = 0; i < axis.size(); ++i)
      for (Index p : axis.forming_points[i]) ASSERT_TRUE(has_path(tree, axis.points[p])) << shape.name;
  }
}

TEST(MergeTree, IsConservativeByFitting) {
  for (const Shape& shape : shapes()) {
    const Surface surface(shape.mesh);
    const auto [tree, report] = merge_tree(surface, axis_of(surface), {.depth = 2});
    EXPECT_EQ(report.levels.size(), tree.depth()) << shape.name;
    expect_conservative(tree, surface, shape.name);
  }
}

TEST(MergeTree, BecomesConservativeByGrowth) {
  for (const Shape& shape : shapes()) {
    const Surface surface(shape.mesh);
    const SphereTree merged = merge_tree(surface, axis_of(surface), {.closing = MergeClosing::growth}).tree;
    SphereTree grown = merged, covered = merged;
    const CoverReport report = grow_to_cover(grown, surface);
    expect_conservative(grown, surface, shape.name);
    cover(covered, surface);
    expect_conservative(covered, surface, shape.name);
    // Centres stay, and radii grow by whole steps.
    for (std::size_t i = 0; i < merged.nodes.size(); ++i) {
      const double steps = std::log(grown.nodes[i].sphere.radius / merged.nodes[i].sphere.radius) / std::log(1.1);
      EXPECT_NEAR(steps, std::round(steps), 1e-6);
      EXPECT_LE(std::round(steps), report.rounds);
      EXPECT_EQ(grown.nodes[i].sphere.center, merged.nodes[i].sphere.center);
    }
  }
  const Surface surface(torus(16, 8));
  SphereTree tree = octree(surface);
  EXPECT_THROW(grow_to_cover(tree, surface, 1), InputError);
}

TEST(MergeTree, HasNoMoreChildrenAndLevelsThanAskedFor) {
  const Surface surface(torus(24, 12));
  const MedialAxis axis = axis_of(surface);
  for (const MergeClosing closing : {MergeClosing::refit, MergeClosing::growth})
    for (const Index branching : {2u, 5u, 64u})
      for (const Index depth : {1u, branching == 64u ? 2u : 3u}) {
        SphereTree tree = merge_tree(surface, axis, {.depth = depth, .branching = branching, .closing = closing}).tree;
        validate(tree);
        EXPECT_EQ(tree.depth(), depth);
        const bool refit = closing == MergeClosing::refit;
        EXPECT_LE(tree.nodes[0].child_count, branching);
        EXPECT_TRUE(refit || tree.nodes[0].child_count == branching);
        const Index max = refit ? std::min<Index>(64, 3 * branching) : branching;
        std::vector<std::size_t> level(depth + 1, 0), parents(depth + 1, 0);
        for (const SphereNode& node : tree.nodes) {
          EXPECT_LE(node.child_count, max);
          ++level[node.level];
          parents[node.level] += node.child_count > 0;
        }
        for (Index i = 0; i < depth; ++i) EXPECT_LE(level[i + 1], branching * parents[i]);
        if (closing == MergeClosing::growth) cover(tree, surface);
        expect_conservative(tree, surface, "torus");
      }
}

TEST(MergeTree, JoinsComponentsThatAreMoreThanTheChildren) {
  TriangleMesh mesh;
  for (int i = 0; i < 6; ++i) {
    const TriangleMesh part = box(Point(2 * i, 0, 0), Point(2 * i + 1, 1, 1));
    const auto base = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (auto t : part.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
  const Surface surface(mesh);
  const SphereTree tree = merge_tree(surface, axis_of(surface), {.depth = 2, .branching = 3}).tree;
  expect_conservative(tree, surface, "row of boxes");
}

TEST(MergeTree, FitsTighterThanTheOctree) {
  for (const TriangleMesh& mesh : {torus(32, 16), l_shape(), u_shape(0.3)}) {
    const Surface surface(mesh);
    SphereTree tree = merge_tree(surface, axis_of(surface, 1500), {.depth = 2}).tree;
    SphereTree oct = octree(surface, {.depth = tree.depth()});
    measure(tree, surface);
    measure(oct, surface);
    const auto ours = level_figures(tree, surface.bounding_radius());
    const auto theirs = level_figures(oct, surface.bounding_radius());
    for (std::size_t level = 1; level < ours.size(); ++level)
      EXPECT_LT(ours[level].mean_inaccuracy, theirs[level].mean_inaccuracy) << level;
  }
}

TEST(MergeTree, RefusesABranchingThatIsNoBranching) {
  const Surface surface(torus(24, 12));
  const MedialAxis axis = axis_of(surface);
  EXPECT_THROW(merge_tree(surface, axis, {.branching = 1}), InputError);
  EXPECT_THROW(merge_tree(surface, axis, {.branching = 65}), InputError);
  EXPECT_THROW(merge_tree(surface, MedialAxis{}), InputError);
}

TEST(MergeTree, IsTheSameOnOneTwoAndSevenThreads) {
  const Surface surface(u_shape(0.3));
  std::vector<SphereTree> trees;
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    SphereTree tree = merge_tree(surface, axis_of(surface), {.depth = 2}).tree;
    measure(tree, surface);
    trees.push_back(tree);
  }
  EXPECT_TRUE(same_tree(trees[0], trees[1]));
  EXPECT_TRUE(same_tree(trees[0], trees[2]));
}

TEST(MergeTree, StopsWhenCancelled) {
  const Surface surface(torus(24, 12));
  const MedialAxis axis = axis_of(surface);
  EXPECT_THROW(merge_tree(surface, axis, {}, [](std::string_view, double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace orchard
