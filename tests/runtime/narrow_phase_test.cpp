#include "orchard/runtime/narrow_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodies.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

struct Outcome {
  Answer answer;
  std::uint32_t level;
  std::size_t pairs;
  std::uint64_t pair_tests, triangle_tests;
  double upper, lower;
  Vec center, normal;
  double radius;
  std::uint32_t triangle_a, triangle_b;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

Outcome outcome_of(const NarrowPhase& query) {
  const Contact c = query.contact();
  return {query.answer(),
          query.level(),
          query.pairs(),
          query.pair_tests(),
          query.triangle_tests(),
          query.separation_bound(),
          query.lower_bound(),
          c.center,
          c.normal,
          c.radius,
          c.triangle_a,
          c.triangle_b};
}

Outcome exchanged(Outcome o) {
  std::swap(o.triangle_a, o.triangle_b);
  for (double& x : o.normal) x = -x;
  return o;
}

struct Scene {
  std::size_t a, b;
  Pose pose_a, pose_b;
};

Scene random_scene(const std::vector<Body>& all, std::uint64_t seed) {
  Draw draw(seed);
  Scene s{draw.bits() % all.size(), draw.bits() % all.size(), {}, {}};
  const PackedSphereTree &a = all[s.a].tree, &b = all[s.b].tree;
  s.pose_a = centered(a, draw.pose(0));
  s.pose_b = centered(b, draw.pose(draw.uniform(0, a.bounding_radius + b.bounding_radius)));
  return s;
}

TEST(NarrowPhase, GivesTheSameAnswersAtEveryLevelWhenTheBodiesAreExchanged) {
  const auto all = bodies(), copies = all;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    const Scene s = random_scene(all, seed);
    NarrowPhase there(all[s.a].tree, all[s.b].tree), back(copies[s.b].tree, all[s.a].tree);
    there.start(s.pose_a, s.pose_b);
    back.start(s.pose_b, s.pose_a);
    for (;;) {
      ASSERT_EQ(outcome_of(there), exchanged(outcome_of(back)));
      if (there.finished()) break;
      there.refine();
      back.refine();
    }
    ASSERT_TRUE(back.finished());
  }
}

TEST(NarrowPhase, EndsTheSameHoweverBudgetsCutIt) {
  const auto all = bodies();
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE(seed);
    const Scene s = random_scene(all, seed);
    NarrowPhase whole(all[s.a].tree, all[s.b].tree), sliced(all[s.a].tree, all[s.b].tree);
    whole.start(s.pose_a, s.pose_b);
    while (!whole.finished()) whole.refine();
    Draw draw(seed);
    const std::uint64_t most = std::uint64_t{1} << draw.bits() % 9;
    sliced.start(s.pose_a, s.pose_b);
    double bound = sliced.separation_bound();
    while (!sliced.finished()) {
      const Budget budget{.pair_tests = 1 + draw.bits() % most};
      const std::uint64_t spheres = sliced.pair_tests(), triangles = sliced.triangle_tests();
      ASSERT_EQ(sliced.refine({.pair_tests = 0}), sliced.answer());
      sliced.refine(budget);
      const std::uint64_t spent =
          sliced.pair_tests() - spheres + kTriangleTestCost * (sliced.triangle_tests() - triangles);
      ASSERT_LT(spent, budget.pair_tests + 4 * kTriangleTestCost);
      ASSERT_TRUE(spent > 0 || sliced.finished());
      ASSERT_LE(sliced.separation_bound(), bound);
      bound = sliced.separation_bound();
    }
    ASSERT_EQ(outcome_of(whole), outcome_of(sliced));
  }
}

TEST(NarrowPhase, StopsSoonAfterItsTimeAndResumes) {
  const auto all = bodies();
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Scene s = random_scene(all, seed);
    NarrowPhase whole(all[s.a].tree, all[s.b].tree), sliced(all[s.a].tree, all[s.b].tree);
    whole.start(s.pose_a, s.pose_b);
    while (!whole.finished()) whole.refine();
    sliced.start(s.pose_a, s.pose_b);
    while (!sliced.finished()) {
      const std::uint64_t before = sliced.pair_tests() + kTriangleTestCost * sliced.triangle_tests();
      sliced.refine({.time = std::chrono::nanoseconds(0)});
      const std::uint64_t spent = sliced.pair_tests() + kTriangleTestCost * sliced.triangle_tests() - before;
      ASSERT_LT(spent, kClockInterval + 4 * kTriangleTestCost);
    }
    ASSERT_EQ(outcome_of(whole), outcome_of(sliced));
  }
}

TEST(NarrowPhase, CanBeUsedAgainAfterAnyInterruption) {
  const auto all = bodies();
  NarrowPhase reused(all[2].tree, all[5].tree);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Draw draw(seed);
    const Pose pose_a = draw.pose(0), pose_b = draw.pose(draw.uniform(0, 2));
    NarrowPhase fresh(all[2].tree, all[5].tree);
    reused.start(pose_a, pose_b);
    fresh.start(pose_a, pose_b);
    for (std::uint64_t steps = draw.bits() % 8; steps > 0; --steps) {
      const Budget budget{.pair_tests = 1 + draw.bits() % 200};
      reused.refine(budget);
      fresh.refine(budget);
    }
    ASSERT_EQ(outcome_of(reused), outcome_of(fresh)) << seed;
  }
}

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
    NarrowPhase query(one, half);
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
  pair.blocks[0].first[0] = 1;
  pair.blocks[0].count[0] = 2;
  SiblingBlock children = lone_ball(1).blocks[0];
  children.x = {-1, 1};
  children.radius[1] = 1;
  children.count[1] = kLeafBit;
  pair.blocks.push_back(children);
  ASSERT_EQ(structure_fault(pair), nullptr);
  NarrowPhase query(pair, pair);
  const double touch = 1 + std::sqrt(3.0);  // |(1, 0) - (touch, 1)| = 2
  const auto quarter = pose_from_quaternion({std::sqrt(0.5), 0, 0, std::sqrt(0.5)}, {touch, 0, 0});
  EXPECT_EQ(query.start({}, *quarter), Answer::maybe);
  EXPECT_EQ(query.refine(), Answer::maybe);
  EXPECT_EQ(query.pairs(), 2u);
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
  tree.branching = tree.blocks[0].count[0] = count;
  tree.blocks[0].first[0] = tree.depth = 1;
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
    block.count[lane] = kLeafBit;
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
    NarrowPhase query(a, b);
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
    NarrowPhase query(a, b);
    query.start({}, pose);
    query.refine();
    ASSERT_EQ(query.pairs(), meeting) << seed;
    ASSERT_EQ(query.pair_tests(), 1 + a.branching * b.branching);
    ASSERT_LE(query.lower_bound(), std::max(0.0, least));
    if (meeting == 0) continue;
    ASSERT_GE(query.separation_bound(), bound) << seed;
    ASSERT_LE(query.separation_bound(), bound + 1e-3) << seed;
  }
}

TEST(NarrowPhase, NeverSaysNoForPosesThatAreNotNumbers) {
  const auto all = bodies();
  NarrowPhase query(all[2].tree, all[5].tree);
  Pose broken;
  broken.rotation[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(query.start({}, broken), Answer::maybe);
  EXPECT_EQ(query.refine(), Answer::maybe);
  EXPECT_TRUE(query.finished());
}

TEST(NarrowPhase, FindsContactsThatAreExactInFloats) {
  const Body cube{"cube", build_tree(box({0, 0, 0}, {1, 1, 1}), {.branching = 3, .leaf_triangles = 1}), true};
  const struct {
    const char* name;
    Vec at;
    Answer answer;
  } cases[] = {
      {"face on face", {1, 0, 0}, Answer::yes},
      {"face on face, shifted", {0.25, -0.5, -1}, Answer::yes},
      {"edge on edge", {1, 1, 0}, Answer::yes},
      {"corner on corner", {-1, 1, 1}, Answer::yes},
      {"in place", {0, 0, 0}, Answer::yes},
      {"one bit apart", {1 + 0x1p-52, 0, 0}, Answer::no},
      {"one bit apart at a corner", {-1, 1, 1 + 0x1p-52}, Answer::no},
      {"one bit inside", {1 - 0x1p-53, 0, 0}, Answer::yes},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name);
    NarrowPhase query(cube.tree, cube.tree);
    query.start({}, Pose{.translation = c.at});
    while (!query.finished()) query.refine();
    EXPECT_EQ(query.answer(), c.answer);
  }
}

TEST(NarrowPhase, SaysNoForASolidInsideAnother) {
  const auto inner = build_tree(box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1})), outer = build_tree(uv_sphere(16, 12, 1));
  NarrowPhase query(inner, outer);
  query.start({}, {});
  while (!query.finished()) query.refine();
  EXPECT_EQ(query.answer(), Answer::no);  // the surfaces do not touch
  EXPECT_LT(query.separation_bound(), 0.9);
}

TEST(NarrowPhase, ScalesExactlyByPowersOfTwo) {
  const Mesh a = torus(12, 6, 1, 0.3), b = spikes(5, 9, 7);
  const auto tree_a = build_tree(a), tree_b = build_tree(b);
  for (const double scale : {0x1p-20, 0x1p-3, 0x1p10, 0x1p40}) {
    const auto scaled_a = build_tree(scaled(a, scale)), scaled_b = build_tree(scaled(b, scale));
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      Draw draw(seed);
      Pose pose_a = draw.pose(0), pose_b = draw.pose(draw.uniform(0.5, 2));
      NarrowPhase query(tree_a, tree_b);
      query.start(pose_a, pose_b);
      while (!query.finished()) query.refine();
      for (double& x : pose_b.translation) x *= scale;
      NarrowPhase large(scaled_a, scaled_b);
      large.start(pose_a, pose_b);
      while (!large.finished()) large.refine();
      ASSERT_EQ(query.answer(), large.answer());
      ASSERT_EQ(query.pair_tests(), large.pair_tests()) << scale << " " << seed;
      ASSERT_EQ(query.separation_bound() * scale, large.separation_bound());
      ASSERT_EQ(query.lower_bound() * scale, large.lower_bound());
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
