#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "any_broad_phase.h"
#include "oracles.h"
#include "runtime/numbers.h"
#include "worlds.h"

// Steps that a budget interrupts: what is reported is right, what is not yet known is said to be, and every budget gets
// everywhere in time.
namespace orchard::runtime {
namespace {

using test::kStep;

std::vector<Motion> resting(std::size_t n, double ball, std::uint64_t seed) {
  test::Draw draw(seed);
  std::vector<Motion> motions(n);
  for (Motion& motion : motions) {
    motion.position = draw.in_ball(ball);
    motion.radius = draw.uniform(0.5, 1.5);
  }
  return motions;
}

// Steps until every one of the overlaps, which last for ever, has been reported at least once.
int steps_to_find_all(const std::vector<Motion>& motions, const test::AnyOptions& options, std::uint64_t work,
                      int most) {
  const std::vector<BodyPair> expected = test::touching_pairs(motions);
  BroadPhase world = test::make_broad_phase(values_of(motions), options);
  for (std::size_t i = 0; i < motions.size(); ++i) world.add();
  std::set<BodyPair> seen;
  std::uint64_t asked = 0;
  for (int step = 0; step < most; ++step) {
    const Advance now = world.advance(options.common.time_step * step, Budget{.work = work});
    for (const BodyPair& pair : now.pairs) {
      EXPECT_TRUE(std::binary_search(expected.begin(), expected.end(), pair));
      seen.insert(pair);
    }
    EXPECT_EQ(now.incomplete_from == kNoClass, now.left_over == 0);
    if (now.pairs.size() < expected.size()) {
      EXPECT_EQ(now.incomplete_from, 0u) << step;
    }
    EXPECT_LE(world.motions_asked() - asked, work + 1) << step;  // a pair is not split
    asked = world.motions_asked();
    if (seen.size() == expected.size()) return step + 1;
    if (testing::Test::HasFailure()) break;
  }
  ADD_FAILURE() << seen.size() << " of " << expected.size() << " within " << most << " steps at " << work;
  return most;
}

// A window update costs a unit, a pair's test two, and each gets half of the work.
TEST(Budget, OfOneUnitFindsEverythingAmongTenThousandBodies) {
  constexpr std::size_t kBodies = 10'000;
  const std::vector<Motion> motions = resting(kBodies, 150, 1);
  EXPECT_GT(test::touching_pairs(motions).size(), 100u);
  int before = 1 << 30;
  for (const std::uint64_t work : {1u, 2u, 10u, 100u, 1000u, 4500u}) {
    const int most = static_cast<int>(4 * kBodies / work + 8), steps = steps_to_find_all(motions, {}, work, most);
    EXPECT_LT(steps, before) << work;
    before = steps;
  }
}

TEST(Budget, OfOneUnitFindsEverythingByEveryMethod) {
  for (const test::AnyMethod method : test::kMethods) {
    for (const std::size_t n : {2u, 20u, 60u, 250u}) {
      if (method != test::AnyMethod::events && n > 60) continue;
      const std::vector<Motion> motions = resting(n, 2 * std::cbrt(static_cast<double>(n)), n);
      const std::size_t pairs = test::touching_pairs(motions).size();
      for (const std::uint64_t work : {1u, 3u, 7u}) {
        for (const test::Rebuild rebuild : {test::Rebuild::what_intersected, test::Rebuild::everything}) {
          const int most = static_cast<int>(50 + 8 * (n + 2 * pairs) / work);
          steps_to_find_all(motions, {.method = method, .rebuild = rebuild}, work, most);
          if (testing::Test::HasFailure()) FAIL() << static_cast<int>(method) << " " << n;
        }
      }
    }
  }
}

// Bounds expire, bodies move, and the budget is far below what knowing everything would take.
TEST(Budget, ReportsTheMoreTheLargerItIs) {
  constexpr int kSteps = 120;
  const test::MovingBodies bodies({.bodies = 10'000, .ball = 200, .period = 0.5, .end = kSteps * kStep}, 7);
  const std::vector<std::uint64_t> works = {10, 100, 1000, 4500, 20'000};
  std::vector<Motion> motions(bodies.size());
  std::vector<BroadPhase> worlds;
  for (std::size_t w = 0; w < works.size(); ++w) {
    worlds.emplace_back(values_of(motions), BroadPhaseOptions{.time_step = kStep});
    for (std::size_t i = 0; i < bodies.size(); ++i) worlds.back().add();
  }
  std::vector<std::size_t> reported(works.size());
  std::size_t all = 0;
  for (int step = 0; step <= kSteps; ++step) {
    for (BodyIndex i = 0; i < motions.size(); ++i) motions[i] = bodies.motion(i, kStep * step);
    const std::vector<BodyPair> expected = test::touching_pairs(motions);
    all += expected.size();
    for (std::size_t w = 0; w < works.size(); ++w) {
      const Advance now = worlds[w].advance(kStep * step, Budget{.work = works[w]});
      ASSERT_TRUE(std::includes(expected.begin(), expected.end(), now.pairs.begin(), now.pairs.end())) << works[w];
      if (now.incomplete_from == kNoClass) {
        ASSERT_EQ(now.pairs.size(), expected.size()) << works[w];
      }
      reported[w] += now.pairs.size();
    }
  }
  ASSERT_GT(all, 1000u);
  EXPECT_GT(reported[1], 0u);
  for (std::size_t w = 1; w < works.size(); ++w) EXPECT_GE(reported[w], reported[w - 1]) << works[w];
  const auto share = [&](std::size_t w) { return static_cast<double>(reported[w]) / static_cast<double>(all); };
  EXPECT_GT(share(2), 0.75);  // a tenth of the bodies per step
  EXPECT_GT(share(3), 0.95);  // .45 of them
  EXPECT_GT(share(4), 0.99);
}

TEST(Budget, IsSpentOnTheImportantBodiesFirst) {
  constexpr int kSteps = 90;  // up to here the first bounds hold
  const test::MovingBodies bodies({.bodies = 10'000, .ball = 60, .end = 1}, 3);
  std::vector<Motion> motions(bodies.size());
  BroadPhase world(values_of(motions), {.time_step = kStep});
  const auto importance = [](BodyIndex i) { return i % 50 == 0 ? 0u : i % 50 < 5 ? 1u : 9u; };
  for (BodyIndex i = 0; i < bodies.size(); ++i) world.add(static_cast<std::uint8_t>(importance(i)));
  std::size_t important = 0, important_steps = 0, others = 0;
  for (int step = 0; step <= kSteps; ++step) {
    for (BodyIndex i = 0; i < motions.size(); ++i) motions[i] = bodies.motion(i, kStep * step);
    const std::vector<BodyPair> expected = test::touching_pairs(motions);
    const Advance now = world.advance(kStep * step, Budget{.work = 150});  // 200 bodies are in the highest class
    ASSERT_TRUE(std::includes(expected.begin(), expected.end(), now.pairs.begin(), now.pairs.end()));
    for (const BodyPair& pair : expected) {
      const unsigned rank = std::max(importance(pair.a), importance(pair.b));
      const bool found = std::binary_search(now.pairs.begin(), now.pairs.end(), pair);
      ASSERT_TRUE(found || rank >= now.incomplete_from) << step;
      important += rank == 0;
      others += rank > 0 && found;
    }
    important_steps += now.incomplete_from > 0;
  }
  EXPECT_GT(important, 0u);
  EXPECT_GT(important_steps, 70u);
  EXPECT_GT(others, 100u);
}

// What waits in a class that never gets its turn stays bounded in memory.
TEST(Budget, ThatNeverReachesAClassKeepsNoEndlessList) {
  std::vector<Motion> motions = resting(300, 8, 1);
  BroadPhase world(values_of(motions), {.time_step = kStep});
  for (BodyIndex i = 0; i < motions.size(); ++i) world.add(i < 150 ? 0 : 5);
  for (Motion& motion : motions) motion.acceleration = 20;
  std::size_t memory = 0;
  for (int step = 0; step < 4000; ++step) {
    for (Motion& motion : motions) motion.expiry = kStep * (step + 3);  // to be updated again and again
    if (step == 0) {
      world.advance(0);  // all are in the grid, where the important ones find the others from now on
      continue;
    }
    const Advance now = world.advance(kStep * step, Budget{.work = 200});
    EXPECT_EQ(now.incomplete_from, step > 3 ? 0u : now.incomplete_from);
    if (step == 500) memory = world.memory_bytes();
  }
  EXPECT_LT(world.memory_bytes(), 2 * memory);
}

TEST(Budget, LeftOverWorkIsDoneByAStepWithoutOne) {
  const test::MovingBodies bodies({.bodies = 2000, .ball = 40, .end = 1}, 9);
  BroadPhase world(bodies.source(), {.time_step = kStep});
  for (std::size_t i = 0; i < bodies.size(); ++i) world.add(static_cast<std::uint8_t>(i % 3));
  for (int step = 0; step < 90; ++step) {
    const bool limited = step % 7 != 6;
    const Advance now = limited ? world.advance(kStep * step, Budget{.work = 100}) : world.advance(kStep * step);
    if (limited) continue;
    EXPECT_EQ(now.incomplete_from, kNoClass);
    EXPECT_EQ(now.left_over, 0u);
    ASSERT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), bodies.touching(kStep * step)) << step;
  }
}

}  // namespace
}  // namespace orchard::runtime
