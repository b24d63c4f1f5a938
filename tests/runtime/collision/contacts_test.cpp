#include "orchard/runtime/contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodies.h"
#include "improper_poses.h"
#include "support/effort.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

double inner(const Vec& p, const Vec& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

Pose shifted(Pose pose, const Vec& way, double by) {
  for (std::size_t i = 0; i < 3; ++i) pose.translation[i] += by * way[i];
  return pose;
}

// Two boxes one on the other, the scene turned in every direction: the overlap's corners, straight out.
TEST(Contacts, OfABoxOnABoxAreTheCornersOfTheOverlapAndPointStraightOut) {
  const auto ground = build_tree(box({-2, -2, -1}, {2, 2, 0})),
             crate = build_tree(box({-0.5, -0.25, 0}, {0.5, 0.25, 1}));
  const PreparedTree a(ground), b(crate);
  Workspace workspace;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Draw draw(seed);
    Pose scene = draw.pose(draw.uniform(0, 20));
    scene.scale = seed % 3 == 0 ? 0.25 : 1;
    const double depth = draw.uniform(0.001, 0.03), turn = draw.uniform(0, 1.5);
    const Pose on_ground =
        *pose_from_quaternion({std::cos(turn / 2), 0, 0, std::sin(turn / 2)}, {draw.uniform(-1, 1), 0.3, -depth});
    const Pose at_b = compose(scene, on_ground);
    const Vec up = rotate(scene, {0, 0, 1});
    const Manifold m = contacts(workspace, TreePair(a, b), scene, at_b);
    ASSERT_EQ(m.answer, Answer::yes) << seed;
    ASSERT_TRUE(m.complete);
    ASSERT_GT(inner(m.normal, up), 1 - 1e-9) << seed;
    ASSERT_NEAR(m.depth, depth * scene.scale, 1e-9) << seed;
    ASSERT_EQ(m.count, 4u) << seed;
    double least = 1e300;  // the four lie at the crate's four corners, in the ground's plane
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Vec at = transform(inverse(at_b), m.points[i].place);
      ASSERT_NEAR(std::fabs(at[0]), 0.5, 1e-9) << seed;
      ASSERT_NEAR(std::fabs(at[1]), 0.25, 1e-9) << seed;
      for (std::uint32_t j = 0; j < i; ++j) {
        const Vec other = transform(inverse(at_b), m.points[j].place);
        least = std::min(least, std::hypot(at[0] - other[0], at[1] - other[1]));
      }
    }
    ASSERT_GT(least, 0.4) << seed;
    const Manifold mirrored = contacts(workspace, TreePair(b, a), at_b, scene);
    ASSERT_LT(inner(mirrored.normal, up), -1 + 1e-9) << seed;
    ASSERT_NEAR(mirrored.depth, m.depth, 1e-12) << seed;
  }
}

TEST(Contacts, OfSpheresPointAlongTheirCentres) {
  const auto ball = build_tree(uv_sphere(48, 32, 1), {.bounds = false});
  const PreparedTree a(ball);
  Workspace workspace;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Draw draw(seed);
    const Vec way = draw.direction();
    const Pose at = draw.pose(0), other = shifted(draw.pose(0), way, 1.96);
    const Manifold m = contacts(workspace, TreePair(a, a), at, other);
    if (m.answer == Answer::no) continue;
    EXPECT_GT(inner(m.normal, way), 0.99) << seed;
    EXPECT_LT(m.depth, 0.041) << seed;
  }
}

// What the fields say, judged by whole queries: at the end of the way out nothing touches, before it something does,
// and no direction leads out in much less. 300 directions of 12, 5 depths each.
TEST(Contacts, AreTheLeastWayOutByBruteForce) {
  const auto all = bodies();
  std::vector<PreparedTree> trees;
  for (const Body& body : all) trees.emplace_back(body.tree);
  Workspace workspace, other;
  int shallow = 0, longer = 0;
  const int wanted = 60 * static_cast<int>(orchard::test::more());
  for (std::uint64_t seed = orchard::test::first_seed(); shallow < wanted; ++seed) {
    Draw draw(seed);
    const std::size_t i = draw.bits() % 7, j = draw.bits() % 7;  // the closed ones
    const Vec way = draw.direction();
    const Pose a = centered(all[i].tree, draw.pose(0)), turned = draw.pose(0);
    const double reach = all[i].tree.bounding_radius + all[j].tree.bounding_radius;
    const TreePair pair(trees[i], trees[j]);
    const auto at = [&](double d) { return shifted(centered(all[j].tree, turned), way, d); };
    double far = reach;
    while (far > 0 && collide(workspace, pair, a, at(far)).answer != Answer::yes) far -= 0.004 * reach;
    if (far <= 0) continue;
    const Pose b = at(far);
    const Manifold m = contacts(workspace, pair, a, b);
    ASSERT_EQ(m.answer, Answer::yes) << seed;
    ASSERT_TRUE(m.complete) << seed;
    ASSERT_NEAR(inner(m.normal, m.normal), 1, 1e-9) << seed;
    ASSERT_LE(m.depth, 0.05 * reach) << seed;
    const auto answer = [&](const Vec& u, double by) { return collide(other, pair, a, shifted(b, u, by)).answer; };
    const double error = 1e-9 * (reach + 3000);  // one body is that far from its origin
    ASSERT_EQ(answer(m.normal, m.depth + error), Answer::no) << seed;
    for (const double part : {0.1, 0.35, 0.6, 0.85, 0.99}) {
      if (part * m.depth < m.depth - error) {
        ASSERT_EQ(answer(m.normal, part * m.depth), Answer::yes) << seed << " " << part;
      }
    }
    for (std::uint32_t k = 0; k < m.count; ++k) {
      const ContactPoint& p = m.points[k];
      const std::array<long double, 3> place = {p.place[0], p.place[1], p.place[2]};
      ASSERT_LE(point_distance(place, placed_triangles(all[i].tree, a).at(p.triangle_a)), 1e-8) << seed;
      ASSERT_LE(point_distance(place, placed_triangles(all[j].tree, b).at(p.triangle_b)), 1e-8) << seed;
    }
    ++shallow;
    bool shorter = false;
    for (int direction = 0; direction < 300 && !shorter; ++direction) {
      const Vec u = draw.direction();
      for (const double part : {0.25, 0.5, 0.75, 0.95}) {
        shorter = shorter || (m.depth > 100 * error && answer(u, part * m.depth) == Answer::no);
      }
    }
    longer += shorter;
  }
  EXPECT_LE(longer, wanted / 20);
}

// Soups of triangles, some of them without area, on a grid and turned: moved by the depth the second one is free in the
// world, however its faces slide along others.
TEST(Contacts, OfDegenerateSoupsFreeTheBodyThatMovesByTheDepth) {
  Workspace workspace;
  std::uint64_t touching = 0;
  for (std::uint64_t i = 0; i < 2000 * orchard::test::more(); ++i) {
    const std::uint64_t seed = orchard::test::first_seed() + i;
    Draw draw(seed);
    const auto on_grid = [seed](Mesh mesh) {
      if (seed % 2 != 0) return mesh;
      for (Vec& v : mesh.vertices) v = {std::round(2 * v[0]), std::round(2 * v[1]), std::round(2 * v[2])};
      return mesh;
    };
    const auto first = build_tree(on_grid(soup(2 * seed, 8)), {.bounds = false}),
               second = build_tree(on_grid(soup(2 * seed + 1, 8)), {.bounds = false});
    const PreparedTree a(first), b(second);
    const double far = seed % 3 == 0 ? 1e3 : 0;
    const Pose scene = draw.pose(far), at_b = compose(scene, seed % 4 == 0 ? Pose{} : draw.pose(0.3));
    const Manifold m = contacts(workspace, TreePair(a, b), scene, at_b);
    if (m.answer != Answer::yes) continue;
    ++touching;
    const Pose moved = shifted(at_b, m.normal, m.depth);
    ASSERT_EQ(collide(workspace, TreePair(a, b), scene, moved).answer, Answer::no) << seed;
  }
  EXPECT_GT(touching, 300u);
}

// Deep ones, and shallow ones of wide curves, as of shells in each other: judged by 1,000 directions in which the
// second body moves until the answer is no.
TEST(Contacts, AreNoMoreThanHalfDeeperThanTheLeastWayOut) {
  const auto ring = build_tree(torus(20, 10, 1, 0.15), {.bounds = false}),
             star = build_tree(spikes(5, 14, 8), {.bounds = false});
  const PreparedTree a(ring), b(star);
  Workspace workspace;
  std::uint64_t judged = 0;
  for (std::uint64_t i = 0; i < 60 * orchard::test::more(); ++i) {
    Draw draw(orchard::test::first_seed() + i);
    const TreePair pair = i % 3 == 0 ? TreePair(a, a) : i % 3 == 1 ? TreePair(a, b) : TreePair(b, b);
    const Pose at_a = draw.pose(0), at_b = draw.pose(draw.uniform(0.8, 1.8));
    const Manifold m = contacts(workspace, pair, at_a, at_b, {.effort = std::numeric_limits<double>::infinity()});
    if (m.answer != Answer::yes) continue;
    ++judged;
    const double limit = m.depth / 1.5;
    for (int k = 0; k < 1000; ++k) {
      const Vec way = draw.direction();
      for (int step = 1; step <= 10; ++step) {
        const Pose moved = shifted(at_b, way, limit * step / 10);
        ASSERT_NE(collide(workspace, pair, at_a, moved).answer, Answer::no)
            << "seed " << orchard::test::first_seed() + i << " depth " << m.depth << " step " << step;
      }
    }
  }
  EXPECT_GT(judged, 20u);
}

TEST(Contacts, TakeAnyEffortAndOneThatIsNoNumberAsNone) {
  const auto ring = build_tree(torus(20, 10, 1, 0.15), {.bounds = false}),
             small = build_tree(box({-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}));
  const PreparedTree a(ring), b(small);
  Workspace workspace;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Pose& at_b : {Pose{.translation = {0.86, 0, 0}}, Pose{.translation = {1.14, 0, 0}}}) {
    const auto depth = [&](double effort) {
      const Manifold m = contacts(workspace, TreePair(a, b), {}, at_b, {.effort = effort});
      EXPECT_EQ(m.answer, Answer::yes) << effort;
      return m.depth;
    };
    const double none = depth(0);
    EXPECT_EQ(depth(std::nan("")), none);
    EXPECT_EQ(depth(-1), none);
    EXPECT_EQ(depth(-infinity), none);
    EXPECT_LE(depth(infinity), none * (1 + 1e-9));
    EXPECT_LE(depth(infinity), 0.3) << "the tube is that thick";
  }
}

TEST(Contacts, AreNoneWhereNothingTouchesAndGuessedWhereNothingIsKnown) {
  const auto tree = build_tree(box({-1, -1, -1}, {1, 1, 1}));
  auto spheres = tree;  // without triangles
  spheres.triangles.clear(), spheres.vertices.clear(), spheres.leaf_triangles.clear();
  spheres.obb_nodes.clear(), spheres.triangle_blocks.clear(), spheres.supports.clear();
  for (SiblingBlock& block : spheres.blocks) {
    for (std::uint32_t& link : block.link) link = link & kLeafBit ? kEmptyLeaf : link;
  }
  const PreparedTree cube(tree), only_spheres(spheres);
  Workspace workspace;
  const Manifold apart = contacts(workspace, TreePair(cube, cube), {}, Pose{.translation = {2.5, 0, 0}});
  EXPECT_EQ(apart.answer, Answer::no);
  EXPECT_EQ(apart.count, 0u);
  const Manifold guess = contacts(workspace, TreePair(cube, only_spheres), {}, Pose{.translation = {1.5, 0, 0}});
  EXPECT_EQ(guess.answer, Answer::maybe);
  EXPECT_EQ(guess.count, 1u);
  EXPECT_GT(guess.error, 0);
  for (const auto& [name, pose] : improper_poses(Draw(1).pose(1.5))) {
    SCOPED_TRACE(name);
    const Manifold m = contacts(workspace, TreePair(cube, cube), {}, pose);
    EXPECT_EQ(m.answer, Answer::maybe);
    EXPECT_EQ(m.count, 0u);
  }
}

TEST(SignedDistance, GoesSteadilyThroughZero) {
  const auto tree = build_tree(box({-1, -1, -1}, {1, 1, 1}));
  const PreparedTree cube(tree);
  Workspace workspace;
  for (int i = 0; i <= 30; ++i) {
    const double gap = 0.013 * i - 0.2;
    const SignedDistance d =
        signed_distance(workspace, TreePair(cube, cube), {}, Pose{.translation = {2 + gap, 0.3, 0.2}});
    EXPECT_LE(d.lower, gap + 1e-9);
    EXPECT_GE(d.upper, gap - 1e-9);
    EXPECT_LE(d.upper - d.lower, 0.01 * std::fabs(gap) + 1e-9);
    EXPECT_NEAR(d.normal[0], 1, 1e-6) << gap;
  }
}

}  // namespace
}  // namespace orchard::runtime
