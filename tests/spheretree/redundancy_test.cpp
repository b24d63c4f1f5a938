#include "orchard/spheretree/redundancy.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/verify.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

constexpr Selection kSelections[] = {Selection::independent, Selection::acyclic, Selection::exhaustive};

// A conservative tree with spheres to spare: radii of an octree or a merged tree, grown at random.
SphereTree loose_tree(const Surface& surface, std::uint64_t seed) {
  SphereTree tree =
      seed % 2 == 0 ? octree(surface)
                    : merge_tree(surface, axis_of(surface, 300), {.depth = 2, .closing = MergeClosing::growth}).tree;
  cover(tree, surface);
  Random random(seed, 11);
  for (SphereNode& node : tree.nodes)
    if (random.below(3) == 0) node.sphere.radius *= random.uniform(1, 1.5);
  return tree;
}

bool conservative(const SphereTree& tree, const Surface& surface) {
  return surface_coverage(surface, path_balls(tree)).complete();
}

// The tree without the subtree of one node and the parents that it leaves empty.
SphereTree without(const SphereTree& tree, Index node) {
  SphereTree rest;
  std::vector<Index> leaves(tree.nodes.size(), 0), place(tree.nodes.size(), kNone);
  for (Index i = static_cast<Index>(tree.nodes.size()); i-- > 0;) {
    if (i == node) leaves[i] = 0;
    if (i != node && tree.nodes[i].child_count == 0) leaves[i] = 1;
    if (i > 0) leaves[tree.nodes[i].parent] += i == node ? 0 : leaves[i];
  }
  for (Index i = 0; i < tree.nodes.size(); ++i) {
    const Index parent = tree.nodes[i].parent;
    if (leaves[i] == 0 || (parent != kNone && place[parent] == kNone)) continue;
    place[i] = static_cast<Index>(rest.nodes.size());
    rest.nodes.push_back({.sphere = tree.nodes[i].sphere, .parent = parent == kNone ? kNone : place[parent]});
    if (parent != kNone) ++rest.nodes[place[parent]].child_count;
  }
  return rest;
}

TEST(Redundancy, NeverBreaksThePathRule) {
  for (const TriangleMesh& mesh : {l_shape(), torus(24, 12), u_shape(0.3), two_boxes(0.2), open_box()}) {
    const Surface surface(mesh);
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      if (!surface.solid() && seed % 2 == 1) continue;  // no medial axis
      const SphereTree loose = loose_tree(surface, seed);
      for (const Selection selection : kSelections) {
        SphereTree tree = loose;
        const RedundancyReport report = remove_redundant(tree, surface, selection);
        ASSERT_NO_THROW(validate(tree));
        EXPECT_EQ(report.removed, loose.nodes.size() - tree.nodes.size());
        EXPECT_TRUE(conservative(tree, surface)) << "seed " << seed;
        for (const Point& point : points_on(surface, 20, seed)) ASSERT_TRUE(has_path(tree, point)) << "seed " << seed;
        if (selection != Selection::exhaustive || seed > 1) continue;
        measure(tree, surface);
        EXPECT_TRUE(verify(surface, pack(tree, surface)).ok()) << "seed " << seed;
      }
    }
  }
}

TEST(Redundancy, LeavesNoNodeThatCouldGo) {
  for (const TriangleMesh& mesh : {l_shape(), torus(16, 8)}) {
    const Surface surface(mesh);
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      SphereTree tree = loose_tree(surface, seed);
      EXPECT_GT(remove_redundant(tree, surface).removed, 0u);
      for (Index node = 1; node < tree.nodes.size(); ++node)
        EXPECT_FALSE(conservative(without(tree, node), surface)) << "seed " << seed << ", node " << node;
      EXPECT_EQ(remove_redundant(tree, surface).removed, 0u);
    }
  }
}

TEST(Redundancy, RemovesMostByTheExhaustiveSelection) {
  Index total[3] = {};
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Surface surface(l_shape());
    for (int i = 0; i < 3; ++i) {
      SphereTree tree = loose_tree(surface, seed);
      total[i] += remove_redundant(tree, surface, kSelections[i]).removed;
    }
  }
  EXPECT_GT(total[0], 0u);
  EXPECT_GT(total[1], 0u);
  EXPECT_GE(total[2], total[0]);
  EXPECT_GE(total[2], total[1]);
}

// A root with two children that hold everything and one in the hole of a torus that touches nothing.
SphereTree three_in_one(const Surface& surface) {
  const Sphere& ball = surface.bounding_ball();
  SphereTree tree;
  tree.nodes.push_back({.sphere = {ball.center, 1.1 * ball.radius}, .first_child = 1, .child_count = 3});
  for (const double factor : {1.2, 0.05, 1.3})
    tree.nodes.push_back({.sphere = {ball.center, factor * ball.radius}, .parent = 0, .level = 1});
  return tree;
}

TEST(Redundancy, FindsWhatItsSiblingsCover) {
  const Surface surface(torus(16, 8));
  const auto found = redundant_nodes(three_in_one(surface), surface, 1, Coverers::siblings);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].coverers, std::vector<Index>{3});
  EXPECT_EQ(found[2].coverers, std::vector<Index>{1});
  SphereTree tree = three_in_one(surface);
  EXPECT_EQ(remove_redundant(tree, surface).removed, 2u);
  EXPECT_EQ(tree.nodes.size(), 2u);
}

// Nieces that an aunt holds are redundant only if the aunt's own children hold what they hold.
TEST(Redundancy, AnAuntWhoseChildrenDoNotCoverIsNoReasonToRemove) {
  const Surface surface(icosphere(2));
  SphereTree tree;
  const Point center = Point::Zero();
  tree.nodes.push_back({.sphere = {center, 2}, .first_child = 1, .child_count = 2});
  tree.nodes.push_back({.sphere = {center, 1.6}, .parent = 0, .first_child = 3, .child_count = 1, .level = 1});
  tree.nodes.push_back({.sphere = {center, 1.8}, .parent = 0, .first_child = 4, .child_count = 1, .level = 1});
  tree.nodes.push_back({.sphere = {center, 1.5}, .parent = 1, .level = 2});
  tree.nodes.push_back({.sphere = {center + Vector(1, 0, 0), 0.3}, .parent = 2, .level = 2});
  ASSERT_TRUE(conservative(tree, surface));
  const auto found = redundant_nodes(tree, surface, 2, Coverers::aunts);
  EXPECT_EQ(found.size(), 2u);
  for (const Selection selection : kSelections) {
    SphereTree rest = tree;
    remove_redundant(rest, surface, selection);
    EXPECT_TRUE(conservative(rest, surface));
    EXPECT_EQ(rest.nodes.size(), 3u);  // the path to the ball that holds everything
  }
}

TEST(Redundancy, IndependentSelectionTakesNoNodeThatAnotherRestsOn) {
  const std::vector<RedundantNode> chain{{1, {2}}, {2, {3}}, {3, {4}}, {5, {}}};
  EXPECT_EQ(independent_selection(chain), (std::vector<Index>{1, 3, 5}));
}

TEST(Redundancy, AcyclicSelectionTakesChainsWholeAndBreaksCycles) {
  EXPECT_EQ(acyclic_selection(std::vector<RedundantNode>{{1, {2}}, {2, {3}}, {3, {4}}}), (std::vector<Index>{1, 2, 3}));
  // Three in a ring: one stays. Two that hold each other: one stays.
  EXPECT_EQ(acyclic_selection(std::vector<RedundantNode>{{1, {2}}, {2, {3}}, {3, {1}}}).size(), 2u);
  EXPECT_EQ(acyclic_selection(std::vector<RedundantNode>{{1, {2}}, {2, {1}}}).size(), 1u);
}

TEST(Redundancy, SelectionsOfRandomGraphsKeepACovererOfEveryNode) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed, 12);
    const auto count = static_cast<Index>(2 + random.below(30));
    std::vector<RedundantNode> nodes;
    for (Index i = 0; i < count; ++i) {
      RedundantNode node{i, {}};
      for (Index k = 0; k < 3; ++k) {
        const auto other = static_cast<Index>(random.below(count + 4));
        if (other != i) node.coverers.push_back(other);
      }
      nodes.push_back(node);
    }
    const auto is_in = [](const std::vector<Index>& set, Index i) {
      return std::find(set.begin(), set.end(), i) != set.end();
    };
    const auto independent = independent_selection(nodes);
    for (Index i : independent)
      for (Index coverer : nodes[i].coverers) EXPECT_FALSE(is_in(independent, coverer)) << "seed " << seed;
    // Following coverers among those that go must end.
    const auto acyclic = acyclic_selection(nodes);
    std::vector<Index> left = acyclic;
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t k = left.size(); k-- > 0;) {
        const auto& coverers = nodes[left[k]].coverers;
        if (std::any_of(coverers.begin(), coverers.end(), [&](Index c) { return is_in(left, c); })) continue;
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
        moved = true;
      }
    }
    EXPECT_TRUE(left.empty()) << "seed " << seed;
    EXPECT_GE(acyclic.size(), independent.size()) << "seed " << seed;
  }
}

TEST(Redundancy, IsTheSameOnOneTwoAndSevenThreads) {
  const Surface surface(torus(24, 12));
  for (const Selection selection : kSelections) {
    std::vector<SphereTree> trees;
    for (const std::size_t threads : {1u, 2u, 7u}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      trees.push_back(loose_tree(surface, 1));
      remove_redundant(trees.back(), surface, selection);
    }
    EXPECT_TRUE(same_tree(trees[0], trees[1]));
    EXPECT_TRUE(same_tree(trees[0], trees[2]));
  }
}

}  // namespace
}  // namespace orchard
