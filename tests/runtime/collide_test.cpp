#include "orchard/runtime/collide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "bodies.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

bool same(const Verdict& p, const Verdict& q) {
  return p.answer == q.answer && p.separation_bound == q.separation_bound && p.lower_bound == q.lower_bound &&
         p.level == q.level && p.work == q.work && p.contact.center == q.contact.center &&
         p.contact.triangle_a == q.contact.triangle_a && p.contact.triangle_b == q.contact.triangle_b;
}

std::vector<PosePair> poses_of(const Body& a, const Body& b, std::uint64_t count) {
  std::vector<PosePair> poses;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    Draw draw(seed);
    poses.push_back(
        {centered(a.tree, draw.pose(0)),
         centered(b.tree, draw.pose(draw.uniform(0, 1) * (a.tree.bounding_radius + b.tree.bounding_radius)))});
  }
  return poses;
}

TEST(Collide, AnswersABatchAsItAnswersEachPoseWithinTheBudget) {
  const auto all = bodies();
  const Body &a = all[2], &b = all[5];
  const auto poses = poses_of(a, b, 200);
  NarrowPhase pair(a.tree, b.tree), single(a.tree, b.tree);
  for (const std::uint64_t tests :
       {std::uint64_t{1}, std::uint64_t{100}, std::uint64_t{1} << 40, Budget{}.pair_tests}) {
    std::vector<Verdict> verdicts(poses.size());
    collide(pair, poses, verdicts, {.pair_tests = tests});
    int answers[3] = {0, 0, 0};
    for (std::size_t i = 0; i < poses.size(); ++i) {
      ASSERT_TRUE(same(verdicts[i], collide(single, poses[i].a, poses[i].b, {.pair_tests = tests}))) << i;
      ASSERT_TRUE(tests > 1000 || verdicts[i].work < tests + kLeafPairTests * kTriangleTestCost);
      ++answers[static_cast<int>(verdicts[i].answer)];
    }
    EXPECT_EQ(answers[1] == 0, tests > 1000);
    EXPECT_GT(answers[0], 0);
  }
}

TEST(Collide, RepeatsATimedRunFromItsWork) {
  const auto all = bodies();
  const auto poses = poses_of(all[2], all[5], 100);
  NarrowPhase pair(all[2].tree, all[5].tree);
  for (const auto& [a, b] : poses) {
    const Verdict timed = collide(pair, a, b, {.time = std::chrono::microseconds(2)});
    if (timed.work > 0) {
      ASSERT_TRUE(same(timed, collide(pair, a, b, {.pair_tests = timed.work})));
    }
  }
}

TEST(Collide, GivesEveryThreadTheSameAnswersFromSharedTrees) {
  const auto all = bodies();
  const auto poses = poses_of(all[2], all[5], 200);
  std::vector<std::vector<Verdict>> results(4, std::vector<Verdict>(poses.size()));
  std::vector<std::thread> threads;
  for (auto& result : results) {
    threads.emplace_back([&all, &poses, &result] {
      NarrowPhase pair(all[2].tree, all[5].tree);
      collide(pair, poses, result, {.pair_tests = 5000});
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& result : results) {
    EXPECT_TRUE(std::equal(result.begin(), result.end(), results[0].begin(), same));
  }
}

TEST(RoundRobin, GivesEveryPairALevelInTurnAndEndsAsEachAlone) {
  const auto all = bodies();
  for (const std::uint64_t slice : {1u, 50u, 3000u}) {
    std::vector<NarrowPhase> pairs, alone;
    for (std::uint64_t i = 0; i < 12; ++i) {
      const Body &a = all[i % 9], &b = all[(i * 4 + 1) % 9];
      const PosePair at = poses_of(a, b, i + 1).back();
      pairs.emplace_back(a.tree, b.tree).start(at.a, at.b);
      alone.emplace_back(a.tree, b.tree).start(at.a, at.b);
      while (!alone.back().finished()) alone.back().refine();
    }
    RoundRobin round(pairs);
    EXPECT_FALSE(round.refine({.pair_tests = 0}));
    while (!round.refine({.pair_tests = slice})) {
      std::uint32_t least = ~0u, most = 0;
      for (const NarrowPhase& pair : pairs) {
        if (pair.finished()) continue;
        least = std::min(least, pair.level()), most = std::max(most, pair.level());
      }
      ASSERT_LE(most, least + 1) << slice;
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) ASSERT_TRUE(same(pairs[i].verdict(), alone[i].verdict())) << i;
  }
}

TEST(ArticulatedPair, TouchesWhenTwoOfItsPartsDo) {
  const auto all = bodies();
  const std::vector<Part> arm = {{all[2].tree, {}}, {all[5].tree, Pose{.translation = {2.5, 0, 0}}}};
  const std::vector<Part> post = {{all[4].tree, {}}, {all[2].tree, Pose{.translation = {0, 0, 2}}}, {all[7].tree, {}}};
  int yes = 0, no = 0;
  ArticulatedPair pair(arm, post);
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Draw draw(seed);
    const Pose a = draw.pose(0), b = draw.pose(draw.uniform(0, 6));
    const Pose bent = draw.pose(2.5);
    pair.set_local_a(1, bent);
    double bound = 1e300;
    Answer expected = Answer::no;
    for (std::size_t i = 0; i < arm.size(); ++i) {
      for (std::size_t j = 0; j < post.size(); ++j) {
        NarrowPhase single(arm[i].tree, post[j].tree);
        const Pose at = compose(a, i == 1 ? bent : arm[i].local), other = compose(b, post[j].local);
        const Verdict verdict =
            collide(single, at, other, {.pair_tests = std::uint64_t{1} << 40}, Order::level_by_level);
        expected = std::max(expected, verdict.answer);
        bound = std::min(bound, verdict.separation_bound);
      }
    }
    pair.start(a, b);
    while (!pair.finished()) pair.refine({.pair_tests = 500});
    const Verdict verdict = pair.verdict();
    ASSERT_EQ(verdict.answer, expected) << seed;
    if (expected == Answer::no) {
      ASSERT_EQ(verdict.separation_bound, bound) << seed;
    }
    if (expected == Answer::yes) {
      ASSERT_LT(verdict.contact.triangle_a, arm[pair.contact_part_a()].tree.triangles.size());
      ASSERT_LT(verdict.contact.triangle_b, post[pair.contact_part_b()].tree.triangles.size());
      const Pose other = compose(b, post[pair.contact_part_b()].local);
      const PackedSphereTree& touched = pair.contact_part_b() == 0   ? all[4].tree
                                        : pair.contact_part_b() == 1 ? all[2].tree
                                                                     : all[7].tree;
      const auto& c = verdict.contact.center;
      ASSERT_LE(point_distance({c[0], c[1], c[2]}, placed_triangles(touched, other).at(verdict.contact.triangle_b)),
                1e-8);
    }
    (expected == Answer::yes ? yes : no) += 1;
  }
  EXPECT_GT(yes, 20);
  EXPECT_GT(no, 20);
}

}  // namespace
}  // namespace orchard::runtime
