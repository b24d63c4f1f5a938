#include <gtest/gtest.h>

#include <cmath>

#include "orchard/runtime/collide.h"
#include "orchard/runtime/detector.h"
#include "orchard/runtime/distance.h"
#include "orchard/runtime/flexible_tree.h"
#include "runtime/allocation.h"
#include "support.h"
#include "support/query_of_trees.h"

namespace orchard::runtime {
namespace {

using test::Vec;

struct Moves {
  std::vector<std::uint32_t> vertices;
  std::vector<Vec> places;
};

Vec rest_of(const PackedSphereTree& tree, std::uint32_t v) {
  Vec place{};
  for (std::size_t i = 0; i < 3; ++i) place[i] = tree.origin[i] + double{tree.vertices[v][i]};
  return place;
}

// Some vertices, each anywhere within `most` of where it rests.
Moves random_moves(test::Draw& draw, const PackedSphereTree& rest, double share, double most) {
  Moves moves;
  for (std::uint32_t v = 0; v < rest.vertices.size(); ++v) {
    if (draw.uniform(0, 1) > share) continue;
    const Vec way = draw.direction(), from = rest_of(rest, v);
    const double size = draw.uniform(0, 0.999) * most;
    moves.vertices.push_back(v);
    moves.places.push_back({from[0] + size * way[0], from[1] + size * way[1], from[2] + size * way[2]});
  }
  return moves;
}

PackedSphereTree copy_of(const TreeView& view) {
  PackedSphereTree tree;
  tree.origin = view.origin;
  tree.vertices.assign(view.vertices.begin(), view.vertices.end());
  tree.triangles.assign(view.triangles.begin(), view.triangles.end());
  return tree;
}

std::vector<test::Mesh> meshes() { return {test::torus(14, 7, 1, 0.3), test::spikes(5, 10, 8), test::l_shape()}; }

// At every level, so that no level of spheres parts bodies that touch: brute force over all triangles.
TEST(FlexibleTree, TellsWhoTouchesAfterEveryDeformation) {
  int yes = 0, no = 0;
  for (const test::Mesh& mesh : meshes()) {
    const PackedSphereTree rest = test::build_tree(mesh, {.leaf_triangles = 2});
    const PackedSphereTree other = test::build_tree(test::torus(10, 5, 0.8, 0.25));
    test::Draw draw(11);
    FlexibleTree flexible(rest, 0.3);
    ASSERT_TRUE(flexible.valid());
    for (int round = 0; round < 60; ++round) {
      const Moves moves = random_moves(draw, rest, draw.uniform(0.02, 1), round % 3 == 0 ? 0.3 : 0.1);
      ASSERT_TRUE(flexible.move(moves.vertices, moves.places));
      ASSERT_EQ(structure_fault(flexible.view()), nullptr);
      test::OwnNarrowPhase pair(flexible.view(), other);
      test::OwnDistanceQuery distance(flexible.view(), other);
      for (int i = 0; i < 4; ++i) {
        const Pose a, b = draw.pose(draw.uniform(0.8, 2.4));
        const auto p = test::placed_triangles(copy_of(flexible.view()), a);
        const auto q = test::placed_triangles(other, b);
        const bool touch = test::surfaces_intersect(p, q);
        (touch ? yes : no)++;
        const long double apart = touch ? 0 : test::surface_distance(p, q);
        ASSERT_EQ(collide(pair, a, b).answer, touch ? Answer::yes : Answer::no) << round;
        pair.start(a, b);
        while (!pair.finished()) {
          pair.refine();
          ASSERT_GE(apart * (1 + 1e-9L) + 1e-12L, static_cast<long double>(pair.lower_bound()));
          ASSERT_FALSE(touch && pair.answer() == Answer::no);
        }
        ASSERT_EQ(pair.answer(), touch ? Answer::yes : Answer::no);
        distance.start(a, b);
        distance.refine();
        ASSERT_LE(static_cast<long double>(distance.lower()), apart + 1e-9L);
        ASSERT_GE(static_cast<long double>(distance.upper()), apart - 1e-9L);
      }
    }
  }
  EXPECT_GT(yes, 100);
  EXPECT_GT(no, 100);
}

// Every point of a triangle is in all balls of a path: what the spheres' answers rest on.
TEST(FlexibleTree, HoldsEveryTriangleOnAPath) {
  test::Draw draw(3);
  const PackedSphereTree rest = test::build_tree(test::spikes(5, 10, 8), {.branching = 5, .leaf_triangles = 2});
  FlexibleTree flexible(rest, 0.4);
  for (int round = 0; round < 20; ++round) {
    const Moves moves = random_moves(draw, rest, 0.5, 0.4);
    ASSERT_TRUE(flexible.move(moves.vertices, moves.places));
    const TreeView tree = flexible.view();
    std::vector<bool> covered(tree.triangles.size());
    const auto walk = [&](auto&& self, std::uint32_t node, std::vector<std::uint32_t>& path) -> void {
      path.push_back(node);
      const std::uint32_t link = tree.blocks[node / kBlockWidth].link[node % kBlockWidth];
      if (link & kLeafBit) {
        for (const std::uint32_t entry : listed_triangles(tree, link)) {
          const auto& corners = tree.triangles[entry & ~kLeafBit];
          bool inside = true;  // this tree's nodes hold their triangles whole
          for (const std::uint32_t v : corners) {
            for (const std::uint32_t n : path) {
              const SiblingBlock& block = tree.blocks[n / kBlockWidth];
              const std::uint32_t lane = n % kBlockWidth;
              const double dx = double{tree.vertices[v][0]} - double{block.x[lane]};
              const double dy = double{tree.vertices[v][1]} - double{block.y[lane]};
              const double dz = double{tree.vertices[v][2]} - double{block.z[lane]};
              inside = inside && std::sqrt(dx * dx + dy * dy + dz * dz) <= double{block.radius[lane]};
            }
          }
          if (inside) covered[entry & ~kLeafBit] = true;
        }
      } else {
        const Children children = children_of(tree.branching, link);
        for (std::uint32_t i = 0; i < children.count; ++i) self(self, children.first * kBlockWidth + i, path);
      }
      path.pop_back();
    };
    std::vector<std::uint32_t> path;
    walk(walk, 0, path);
    for (std::size_t t = 0; t < covered.size(); ++t) ASSERT_TRUE(covered[t]) << t << " in round " << round;
  }
}

TEST(FlexibleTree, ComesBackToRestAndChangesOnlyWhatMoved) {
  const PackedSphereTree rest = test::build_tree(test::torus(40, 20, 1, 0.3));
  FlexibleTree flexible(rest, 0.2);
  const auto radii = [&] {
    std::vector<float> all;
    for (const SiblingBlock& block : flexible.view().blocks)
      all.insert(all.end(), block.radius.begin(), block.radius.end());
    for (const ObbNodeBlock& block : flexible.view().obb_nodes)
      all.insert(all.end(), block.radius.begin(), block.radius.end());
    return all;
  };
  const std::vector<float> before = radii();
  EXPECT_EQ(flexible.looseness(), 0);
  const Vec place = rest_of(rest, 17);
  const std::uint32_t vertex = 17;
  const Vec moved = {place[0] + 0.1, place[1], place[2] + 0.05};
  const std::size_t allocated = test::allocations;
  ASSERT_TRUE(flexible.move({&vertex, 1}, {&moved, 1}));
  EXPECT_EQ(test::allocations, allocated);
  EXPECT_GT(flexible.looseness(), 0);
  const std::vector<float> after = radii();
  std::size_t changed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) changed += before[i] != after[i];
  EXPECT_GT(changed, 0u);
  EXPECT_LT(changed, before.size() / 20);
  ASSERT_TRUE(flexible.move({&vertex, 1}, {&place, 1}));
  EXPECT_EQ(radii(), before);
  EXPECT_NEAR(flexible.looseness(), 0, 1e-12);

  test::Draw draw(1);
  const Moves all = random_moves(draw, rest, 1, 0.2);
  ASSERT_TRUE(flexible.move(all.vertices, all.places));
  EXPECT_TRUE(flexible.worth_rebuilding());
}

TEST(FlexibleTree, RefusesWhatItDoesNotAllow) {
  const PackedSphereTree rest = test::build_tree(test::torus(12, 6, 1, 0.3));
  FlexibleTree flexible(rest, 0.1);
  const auto refused = [&](std::uint32_t vertex, const Vec& place) {
    const auto before = copy_of(flexible.view()).vertices;
    const bool moved = flexible.move({&vertex, 1}, {&place, 1});
    EXPECT_EQ(copy_of(flexible.view()).vertices, before);
    return !moved;
  };
  const Vec place = rest_of(rest, 0);
  EXPECT_TRUE(refused(0, {place[0] + 0.11, place[1], place[2]}));
  EXPECT_TRUE(refused(0, {NAN, place[1], place[2]}));
  EXPECT_TRUE(refused(static_cast<std::uint32_t>(rest.vertices.size()), place));
  EXPECT_FALSE(FlexibleTree(rest, -1).valid());
  EXPECT_FALSE(FlexibleTree(rest, NAN).valid());
  EXPECT_FALSE(FlexibleTree(rest, 1e18).valid());
}

// In a detector: bodies at rest are answered again once their shape has changed.
TEST(FlexibleTree, ChangesTheAnswersOfADetector) {
  const PackedSphereTree rest = test::build_tree(test::torus(20, 10, 1, 0.3));
  FlexibleTree flexible(rest, 0.5);
  std::vector<BodyState> states(2);
  Detector detector(states_of(states));
  const ShapeId cloth = detector.add_shape(flexible.view()), ball = detector.add_sphere(0.1);
  const BodyId a = detector.add_body({{cloth, {}}}), b = detector.add_body({{ball, {}}});
  states[b.index].pose.translation = {1.6, 0, 0};
  EXPECT_TRUE(detector.sleep(a));
  EXPECT_TRUE(detector.sleep(b));
  int time = 0;
  const auto step = [&] { return detector.step(0.01 * time++); };
  EXPECT_TRUE(step().events.empty());
  EXPECT_TRUE(step().events.empty());
  std::vector<std::uint32_t> vertices;
  std::vector<Vec> places;
  for (std::uint32_t v = 0; v < rest.vertices.size(); ++v) {
    const Vec place = rest_of(rest, v);
    vertices.push_back(v), places.push_back({place[0] + 0.3, place[1], place[2]});
  }
  ASSERT_TRUE(flexible.move(vertices, places));
  EXPECT_TRUE(detector.shape_changed(cloth));
  EXPECT_FALSE(detector.shape_changed(99));
  const Frame frame = step();
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].change, PairChange::begin);
}

}  // namespace
}  // namespace orchard::runtime
