#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "orchard/runtime/narrow_phase.h"
#include "support.h"
#include "support/query_of_trees.h"

// The sphere levels alone, on trees without triangles.
namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

// One ball around the origin, without triangles.
PackedSphereTree lone_ball(float radius) {
  PackedSphereTree tree = build_tree(Mesh{});
  tree.blocks[0].radius[0] = tree.blocks[0].error[0] = radius;
  tree.blocks[0].depth[0] = 0;
  tree.bounding_radius = double{radius};
  return tree;
}

TEST(NarrowPhase, CountsTouchingBallsAsMeeting) {
  const PackedSphereTree one = lone_ball(1), half = lone_ball(0.5);
  const std::array<double, 3> ways[] = {{1, 0, 0}, {0, -1, 0}, {0.6, 0, 0.8}, {2 / 3., -2 / 3., 1 / 3.}};
  for (const auto& way : ways) {
    const auto at = [&way](double d) { return Pose{.translation = {d * way[0], d * way[1], d * way[2]}}; };
    test::OwnNarrowPhase query(one, half);
    EXPECT_EQ(query.start({}, at(1.5)), Answer::maybe);
    EXPECT_TRUE(query.finished());  // there is nothing deeper, so "maybe" is final
    EXPECT_EQ(query.start({}, at(1.5 + 1e-9)), Answer::no);
    EXPECT_NEAR(query.lower_bound(), 1e-9, 1e-10);
    EXPECT_EQ(query.start(at(-1e9), at(1e9)), Answer::no);
    EXPECT_NEAR(query.lower_bound(), 2e9, 10);
    EXPECT_EQ(query.start({}, at(1e200)), Answer::maybe);  // beyond arithmetic: nothing is claimed
  }
}

TEST(NarrowPhase, CountsTouchingChildrenAsMeeting) {
  // Two balls of radius 1 on the x axis below a root of radius 2, and the same turned by 90 degrees about z.
  PackedSphereTree pair = lone_ball(2);
  pair.branching = 2;
  pair.depth = 1;
  pair.node_count = 3;
  pair.blocks[0].link[0] = inner_link(2, {1, 2});
  SiblingBlock children = lone_ball(1).blocks[0];
  children.x = {-1, 1};
  children.radius[1] = 1;
  children.link[1] = kEmptyLeaf;
  pair.blocks.push_back(children);
  ASSERT_EQ(structure_fault(pair), nullptr);
  test::OwnNarrowPhase query(pair, pair);
  const double touch = 1 + std::sqrt(3.0);  // |(1, 0) - (touch, 1)| = 2
  const auto quarter = pose_from_quaternion({std::sqrt(0.5), 0, 0, std::sqrt(0.5)}, {touch, 0, 0});
  EXPECT_EQ(query.start({}, *quarter), Answer::maybe);
  EXPECT_EQ(query.refine(), Answer::maybe);
  EXPECT_EQ(query.progress().pairs, 2u);
  EXPECT_TRUE(query.finished());
  Pose apart = *quarter;
  apart.translation[0] += 1e-4;
  EXPECT_EQ(query.start({}, apart), Answer::maybe);
  EXPECT_EQ(query.refine(), Answer::no);
  EXPECT_GT(query.lower_bound(), 0);
  EXPECT_LT(query.lower_bound(), 1e-4);
}

// A large root over balls of all sizes, some blocks of them, without triangles.
PackedSphereTree scattered_balls(Draw& draw, std::uint32_t count) {
  PackedSphereTree tree = lone_ball(100);
  tree.branching = count;
  tree.depth = 1;
  tree.blocks[0].link[0] = inner_link(count, {1, count});
  tree.node_count = 1 + count;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i % kBlockWidth == 0) tree.blocks.emplace_back().radius.fill(-1);
    SiblingBlock& block = tree.blocks.back();
    const std::uint32_t lane = i % kBlockWidth;
    for (auto* coordinate : {&block.x, &block.y, &block.z}) {
      (*coordinate)[lane] = static_cast<float>(draw.uniform(-10, 10));
    }
    block.radius[lane] = static_cast<float>(std::exp2(draw.uniform(-20, 3)));
    block.error[lane] = static_cast<float>(draw.uniform(0, 30));
    block.depth[lane] = static_cast<float>(draw.uniform(-20, 20));
    block.link[lane] = kEmptyLeaf;
  }
  tree.blocks[0].error[0] = tree.blocks[0].depth[0] = 200;
  return tree;
}

TEST(NarrowPhase, KeepsBallsThatTouchByLessThanFloatsCanTell) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Draw draw(seed);
    const PackedSphereTree a = scattered_balls(draw, 1), b = scattered_balls(draw, 1);
    const SiblingBlock &p = a.blocks[1], &q = b.blocks[1];
    const double reach = double{p.radius[0]} + q.radius[0];
    const Pose pose_a = draw.pose(3);
    Pose pose_b = draw.pose(0);
    // Moves b's ball to where the gap is as wanted.
    const Vec from = transform(pose_a, {p.x[0], p.y[0], p.z[0]}), to = rotate(pose_b, {q.x[0], q.y[0], q.z[0]});
    const Vec way = draw.direction();
    const auto place = [&](double gap) {
      for (std::size_t i = 0; i < 3; ++i) pose_b.translation[i] = from[i] + (reach + gap) * way[i] - to[i];
    };
    test::OwnNarrowPhase query(a, b);
    place(-1e-13);
    query.start(pose_a, pose_b);
    ASSERT_EQ(query.refine(), Answer::maybe) << seed;
    place(1e-5);  // within the slack, which the roots' extent of 100 makes some 2e-4
    query.start(pose_a, pose_b);
    query.refine();
    ASSERT_LE(query.lower_bound(), 1e-5) << seed;
    place(2e-3);
    query.start(pose_a, pose_b);
    ASSERT_EQ(query.refine(), Answer::no) << seed;
    ASSERT_LE(query.lower_bound(), 2e-3) << seed;
    ASSERT_GT(query.lower_bound(), 1e-3) << seed;
  }
}

TEST(NarrowPhase, MeetsExactlyTheBallsThatMeetAndReportsTheLeastBoundOfThem) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Draw draw(seed);
    const auto count = static_cast<std::uint32_t>(1 + draw.bits() % 40);
    const PackedSphereTree a = scattered_balls(draw, count), b = scattered_balls(draw, 1 + count % 13);
    const Pose pose = draw.pose(draw.uniform(0, 10));
    std::size_t meeting = 0;
    double least = std::numeric_limits<double>::infinity(), bound = least;
    for (std::uint32_t i = 0; i < a.branching; ++i) {
      for (std::uint32_t j = 0; j < b.branching; ++j) {
        const SiblingBlock &p = a.blocks[1 + i / 8], &q = b.blocks[1 + j / 8];
        const Vec c = transform(pose, {q.x[j % 8], q.y[j % 8], q.z[j % 8]});
        const double distance = std::hypot(c[0] - p.x[i % 8], c[1] - p.y[i % 8], c[2] - p.z[i % 8]);
        const double gap = distance - p.radius[i % 8] - q.radius[j % 8];
        meeting += gap <= 1e-3;
        ASSERT_FALSE(gap > 0 && gap < 1e-3) << "choose another seed than " << seed;
        least = std::min(least, gap);
        if (gap > 0) continue;
        const double errors = double{p.error[i % 8]} + q.error[j % 8], depths = double{p.depth[i % 8]} + q.depth[j % 8];
        bound = std::min(bound, std::max(0.0, std::min(errors, distance + depths)));
      }
    }
    test::OwnNarrowPhase query(a, b);
    query.start({}, pose);
    query.refine();
    ASSERT_EQ(query.progress().pairs, meeting) << seed;
    ASSERT_EQ(query.progress().pair_tests, 1 + a.branching * b.branching);
    ASSERT_LE(query.lower_bound(), std::max(0.0, least));
    if (meeting == 0) continue;
    ASSERT_GE(query.separation_bound(), bound) << seed;
    ASSERT_LE(query.separation_bound(), bound + 1e-3) << seed;
  }
}

}  // namespace
}  // namespace orchard::runtime
