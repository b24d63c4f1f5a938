#include "orchard/runtime/narrow_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodies.h"
#include "support/query_of_trees.h"

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
          query.progress().level,
          query.progress().pairs,
          query.progress().pair_tests,
          query.progress().triangle_tests,
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

struct PosedBodies {
  std::size_t a, b;
  Pose pose_a, pose_b;
};

PosedBodies random_scene(const std::vector<Body>& all, std::uint64_t seed) {
  Draw draw(seed);
  PosedBodies s{draw.bits() % all.size(), draw.bits() % all.size(), {}, {}};
  const PackedSphereTree &a = all[s.a].tree, &b = all[s.b].tree;
  s.pose_a = centered(a, draw.pose(0));
  s.pose_b = centered(b, draw.pose(draw.uniform(0, a.bounding_radius + b.bounding_radius)));
  return s;
}

TEST(NarrowPhase, GivesTheSameAnswersAtEveryLevelWhenTheBodiesAreExchanged) {
  const auto all = bodies();
  const auto copies = all;  // other trees, of the same values
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    const PosedBodies s = random_scene(all, seed);
    test::OwnNarrowPhase there(all[s.a].tree, all[s.b].tree), back(copies[s.b].tree, all[s.a].tree);
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
    const PosedBodies s = random_scene(all, seed);
    test::OwnNarrowPhase whole(all[s.a].tree, all[s.b].tree), sliced(all[s.a].tree, all[s.b].tree);
    whole.start(s.pose_a, s.pose_b);
    while (!whole.finished()) whole.refine();
    Draw draw(seed);
    const std::uint64_t most = std::uint64_t{1} << draw.bits() % 9;
    sliced.start(s.pose_a, s.pose_b);
    double bound = sliced.separation_bound();
    while (!sliced.finished()) {
      const Budget budget{.work = 1 + draw.bits() % most};
      const std::uint64_t before = sliced.progress().work;
      ASSERT_EQ(sliced.refine({.work = 0}), sliced.answer());
      sliced.refine(budget);
      const std::uint64_t spent = sliced.progress().work - before;
      ASSERT_LT(spent, budget.work + kLeafPairTests * kTriangleTestCost);
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
    const PosedBodies s = random_scene(all, seed);
    test::OwnNarrowPhase whole(all[s.a].tree, all[s.b].tree), sliced(all[s.a].tree, all[s.b].tree);
    whole.start(s.pose_a, s.pose_b);
    while (!whole.finished()) whole.refine();
    sliced.start(s.pose_a, s.pose_b);
    while (!sliced.finished()) {
      const std::uint64_t before = sliced.progress().work;
      sliced.refine({.time = std::chrono::nanoseconds(0)});
      ASSERT_LT(sliced.progress().work - before, kClockInterval + kLeafPairTests * kTriangleTestCost);
    }
    ASSERT_EQ(outcome_of(whole), outcome_of(sliced));
  }
}

TEST(NarrowPhase, ReplaysATimedRunFromItsCount) {
  const auto all = bodies();
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const PosedBodies s = random_scene(all, seed);
    test::OwnNarrowPhase timed(all[s.a].tree, all[s.b].tree), replayed(all[s.a].tree, all[s.b].tree);
    timed.start(s.pose_a, s.pose_b);
    for (std::uint64_t calls = seed % 9; calls > 0; --calls) {
      timed.refine({.time = std::chrono::nanoseconds(seed % 3 * 500)});
    }
    replayed.start(s.pose_a, s.pose_b);
    while (replayed.progress().work < timed.progress().work)
      replayed.refine({.work = timed.progress().work - replayed.progress().work});
    ASSERT_EQ(outcome_of(timed), outcome_of(replayed)) << seed;
  }
}

TEST(NarrowPhase, TreatsAScaledInstanceAsTheScaledBody) {
  const Mesh mesh = spikes(5, 9, 7);
  const auto tree = build_tree(mesh), other = build_tree(torus(12, 6, 1, 0.3));
  for (const double scale : {0.25, 0.5, 2.0, 8.0}) {
    const auto scaled_tree = build_tree(scaled(mesh, scale));
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Draw draw(seed);
      const Pose plain = draw.pose(0), at = draw.pose(draw.uniform(0.5, 1) * (1 + scale));
      Pose instance = plain;
      instance.scale = scale;
      test::OwnNarrowPhase by_pose(tree, other), by_tree(scaled_tree, other);
      by_pose.start(instance, at), by_tree.start(plain, at);
      while (!by_pose.finished()) by_pose.refine();
      while (!by_tree.finished()) by_tree.refine();
      ASSERT_EQ(by_pose.answer(), by_tree.answer()) << seed;
      ASSERT_NEAR(by_pose.separation_bound(), by_tree.separation_bound(), 1e-5 * (1 + scale)) << seed;
      ASSERT_NEAR(by_pose.lower_bound(), by_tree.lower_bound(), 1e-5 * (1 + scale)) << seed;
      const Contact p = by_pose.contact(), q = by_tree.contact();
      ASSERT_NEAR(p.radius, q.radius, 1e-3 * (1 + scale)) << seed;
    }
  }
}

TEST(NarrowPhase, CanBeUsedAgainAfterAnyInterruption) {
  const auto all = bodies();
  test::OwnNarrowPhase reused(all[2].tree, all[5].tree);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Draw draw(seed);
    const Pose pose_a = draw.pose(0), pose_b = draw.pose(draw.uniform(0, 2));
    test::OwnNarrowPhase fresh(all[2].tree, all[5].tree);
    reused.start(pose_a, pose_b);
    fresh.start(pose_a, pose_b);
    for (std::uint64_t steps = draw.bits() % 8; steps > 0; --steps) {
      const Budget budget{.work = 1 + draw.bits() % 200};
      reused.refine(budget);
      fresh.refine(budget);
    }
    ASSERT_EQ(outcome_of(reused), outcome_of(fresh)) << seed;
  }
}

TEST(NarrowPhase, NeverSaysNoForPosesThatAreNotNumbers) {
  const auto all = bodies();
  test::OwnNarrowPhase query(all[2].tree, all[5].tree);
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
    test::OwnNarrowPhase query(cube.tree, cube.tree);
    query.start({}, Pose{.translation = c.at});
    while (!query.finished()) query.refine();
    EXPECT_EQ(query.answer(), c.answer);
  }
}

TEST(NarrowPhase, SaysNoForASolidInsideAnother) {
  const auto inner = build_tree(box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1})), outer = build_tree(uv_sphere(16, 12, 1));
  test::OwnNarrowPhase query(inner, outer);
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
      test::OwnNarrowPhase query(tree_a, tree_b);
      query.start(pose_a, pose_b);
      while (!query.finished()) query.refine();
      for (double& x : pose_b.translation) x *= scale;
      test::OwnNarrowPhase large(scaled_a, scaled_b);
      large.start(pose_a, pose_b);
      while (!large.finished()) large.refine();
      ASSERT_EQ(query.answer(), large.answer());
      ASSERT_EQ(query.progress().pair_tests, large.progress().pair_tests) << scale << " " << seed;
      ASSERT_EQ(query.separation_bound() * scale, large.separation_bound());
      ASSERT_EQ(query.lower_bound() * scale, large.lower_bound());
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
