#include "orchard/runtime/collide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "bodies.h"
#include "collision/coherent_pair.h"
#include "support/query_of_trees.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

bool same(const Verdict& p, const Verdict& q) {
  return p.answer == q.answer && p.separation_bound == q.separation_bound && p.lower_bound == q.lower_bound &&
         p.level == q.level && p.work == q.work && p.contact.center == q.contact.center &&
         p.contact.triangle_a == q.contact.triangle_a && p.contact.triangle_b == q.contact.triangle_b;
}

struct PosePair {
  Pose a, b;
};

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

TEST(Collide, AnswersEachPoseWithinTheBudgetWhateverWasAskedBefore) {
  const auto all = bodies();
  const Body &a = all[2], &b = all[5];
  const auto poses = poses_of(a, b, 200);
  test::OwnNarrowPhase pair(a.tree, b.tree);
  for (const std::uint64_t tests : {std::uint64_t{1}, std::uint64_t{100}, std::uint64_t{1} << 40, Budget{}.work}) {
    int answers[3] = {0, 0, 0};
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Verdict verdict = collide(pair, poses[i].a, poses[i].b, {.work = tests});
      test::OwnNarrowPhase single(a.tree, b.tree, 1);
      ASSERT_TRUE(same(verdict, collide(single, poses[i].a, poses[i].b, {.work = tests}))) << i;
      ASSERT_TRUE(tests > 1000 || verdict.work < tests + kLeafPairTests * kTriangleTestCost);
      ++answers[static_cast<int>(verdict.answer)];
    }
    EXPECT_EQ(answers[1] == 0, tests > 1000);
    EXPECT_GT(answers[0], 0);
  }
}

TEST(Collide, EndsAtTheFirstLookAtTheClockThatTheTimeIsOver) {
  constexpr std::uint64_t kStep = std::uint64_t{kLeafPairTests} * kTriangleTestCost + 2 * kBlockWidth;
  const auto all = bodies();
  test::OwnNarrowPhase pair(all[2].tree, all[5].tree);
  int longer = 0;
  for (const auto& [a, b] : poses_of(all[2], all[5], 100)) {
    longer += collide(pair, a, b).work > kClockInterval + kStep;
    ASSERT_LE(collide(pair, a, b, {.time = std::chrono::nanoseconds(0)}).work, kClockInterval + kStep);
  }
  EXPECT_GT(longer, 0);
}

TEST(CoherentPair, RepeatsATimedSearchFromItsWork) {
  const auto all = bodies();
  const PreparedTree first(all[2].tree), second(all[5].tree);
  Workspace workspace;
  int cut = 0, searched = 0;
  for (auto [a, b] : poses_of(all[2], all[5], 200)) {
    TreePair pair(first, second);
    collide_coherently(workspace, pair, a, b);
    for (double& t : b.translation) t += 0.1 * all[5].tree.bounding_radius;
    Verdict known;
    if (CoherentPair(workspace, pair, a, b).recall(known)) continue;
    TreePair again = pair;
    const Verdict timed = CoherentPair(workspace, pair, a, b).search({.time = std::chrono::nanoseconds(500)});
    ASSERT_TRUE(same(timed, CoherentPair(workspace, again, a, b).search({.work = timed.work})));
    cut += timed.answer == Answer::maybe, ++searched;
  }
  EXPECT_GT(searched, 0);
  EXPECT_GT(cut, 0);
}

TEST(Collide, RepeatsATimedRunFromItsWork) {
  const auto all = bodies();
  const auto poses = poses_of(all[2], all[5], 100);
  test::OwnNarrowPhase pair(all[2].tree, all[5].tree);
  for (const auto& [a, b] : poses) {
    const Verdict timed = collide(pair, a, b, {.time = std::chrono::microseconds(2)});
    if (timed.work > 0) {
      ASSERT_TRUE(same(timed, collide(pair, a, b, {.work = timed.work})));
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
      test::OwnNarrowPhase pair(all[2].tree, all[5].tree);
      for (std::size_t i = 0; i < poses.size(); ++i) result[i] = collide(pair, poses[i].a, poses[i].b, {.work = 5000});
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& result : results) {
    EXPECT_TRUE(std::equal(result.begin(), result.end(), results[0].begin(), same));
  }
}

// Rings that hang in each other stay near without touching, so their roots are tested at some poses only. In the end
// they move far apart. Some searches have a budget that is too small.
TEST(CoherentPair, AnswersAsCollideDoesWhileHullsOverlapAndAfterwards) {
  const PackedSphereTree ring = build_tree(torus(24, 12, 1, 0.4));
  const PreparedTree tree(ring);
  Workspace workspace, other;
  TreePair pair(tree, tree);
  Draw draw(7);
  const Pose a;
  Pose b = *pose_from_quaternion({std::sqrt(0.5), std::sqrt(0.5), 0, 0}, {1, 0, 0});
  std::array<int, 3> answers{};
  int searched = 0;
  for (int step = 0; step < 400; ++step) {
    const double away = step < 300 ? 0 : 0.05 * (step - 300);
    b.translation = {1 + away, draw.uniform(-0.1, 0.1), draw.uniform(-0.1, 0.1)};
    Verdict known;
    CoherentPair coherent(workspace, pair, a, b);
    const Budget budget = step % 7 == 0 ? Budget{.work = static_cast<std::uint64_t>(step)} : Budget{};
    if (!coherent.recall(known)) known = coherent.search(budget), searched += step < 300;
    if (step % 7 == 0 && known.answer == Answer::maybe) continue;
    ASSERT_EQ(known.answer, collide(other, TreePair(tree, tree), a, b).answer) << step;
    ++answers[static_cast<std::size_t>(known.answer)];
  }
  EXPECT_GT(searched, 100);
  EXPECT_GT(answers[static_cast<std::size_t>(Answer::yes)], 0);
  EXPECT_GT(answers[static_cast<std::size_t>(Answer::no)], 200);
}

}  // namespace
}  // namespace orchard::runtime
