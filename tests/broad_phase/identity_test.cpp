#include <gtest/gtest.h>

#include <set>

#include "any_broad_phase.h"
#include "runtime/numbers.h"
#include "worlds.h"

// Which bodies there are: ids, and worlds that are emptied and filled again.
namespace orchard::runtime {
namespace {

using test::kStep;

TEST(BodyIds, OfBodiesRemovedAreRefusedForGood) {
  BroadPhase world({}, {});
  std::vector<BodyId> ids(5);
  for (BodyId& id : ids) id = world.add_static(Motion{});
  EXPECT_TRUE(world.remove(ids[3]));
  EXPECT_FALSE(world.remove(ids[3]));  // twice
  EXPECT_EQ(world.size(), 4u);
  EXPECT_EQ(world.id_of(3), kNoBody);
  const BodyId next = world.add_static(Motion{}), after = world.add_static(Motion{});
  EXPECT_EQ(next.index, 3u);  // again, for another body
  EXPECT_EQ(after.index, 5u);
  EXPECT_NE(next, ids[3]);
  EXPECT_EQ(world.id_of(3), next);
  EXPECT_FALSE(world.contains(ids[3]));
  EXPECT_FALSE(world.remove(ids[3]));
  EXPECT_FALSE(world.cancel(ids[3]));
  EXPECT_FALSE(world.set_importance(ids[3], 7));
  EXPECT_FALSE(world.move_static(ids[3], Motion{}));
  EXPECT_TRUE(world.contains(next));
  EXPECT_EQ(world.size(), 6u);
}

TEST(BodyIds, ThatNeverWereAreRefused) {
  std::vector<Motion> values(8);
  BroadPhase world(values_of(values), {});
  const auto refused = [&](BodyId id) {
    return !world.remove(id) && !world.cancel(id) && !world.teleport(id) && !world.set_importance(id, 1) &&
           !world.move_static(id, Motion{}) && !world.contains(id);
  };
  EXPECT_TRUE(refused(kNoBody));  // of an empty world
  EXPECT_TRUE(refused(BodyId{0, 0}));
  const BodyId moving = world.add();
  for (const BodyId id : {kNoBody, BodyId{1'000'000, 1}, BodyId{1, 1}, BodyId{0, 0}, BodyId{0, 2}, BodyId{0, 3},
                          BodyId{0xfffffffeu, 1}, BodyId{0xffffffffu, 1}}) {
    EXPECT_TRUE(refused(id)) << id.index << " " << id.generation;
  }
  EXPECT_FALSE(world.move_static(moving, Motion{}));  // it is not static
  EXPECT_TRUE(world.advance(0).pairs.empty());
  EXPECT_TRUE(world.remove(moving));
  EXPECT_TRUE(refused(moving));
}

TEST(BodyIds, AreNeverGivenTwice) {
  BroadPhase world({}, {});
  std::set<std::pair<BodyIndex, std::uint32_t>> given;
  std::vector<BodyId> now;
  test::Draw draw(1);
  for (int i = 0; i < 20000; ++i) {
    if (now.empty() || draw.uniform(0, 1) < 0.5) {
      now.push_back(world.add_static(Motion{}));
      ASSERT_TRUE(given.emplace(now.back().index, now.back().generation).second);
    } else {
      const std::size_t which = draw.bits() % now.size();
      ASSERT_TRUE(world.remove(now[which]));
      now.erase(now.begin() + static_cast<std::ptrdiff_t>(which));
    }
    ASSERT_EQ(world.size(), now.size());
  }
}

// An application whose bodies all keep where they are.
struct Resting {
  std::vector<Motion> values;
  std::vector<BodyId> ids;
  BroadPhase world;
  test::Draw draw;

  Resting(const test::AnyOptions& options, std::uint64_t seed)
      : world(test::make_broad_phase(values_of(values), options)), draw(seed) {}

  void add() {
    const BodyId id = world.add();
    if (id.index >= values.size()) values.resize(id.index + 1);
    Motion& motion = values[id.index];
    motion.position = draw.in_ball(8);
    motion.radius = draw.uniform(0.5, 1.5);
    ids.push_back(id);
  }
  void remove_all() {
    for (const BodyId id : ids) ASSERT_TRUE(world.remove(id));
    ids.clear();
  }
  void expect_right(double time) {
    std::vector<BodyIndex> bodies;
    for (const BodyId id : ids) bodies.push_back(id.index);
    std::sort(bodies.begin(), bodies.end());
    std::vector<BodyPair> expected;
    for (const BodyIndex a : bodies) {
      for (const BodyIndex b : bodies) {
        if (a < b && spheres_touch(values[a], values[b])) expected.push_back({a, b});
      }
    }
    const Advance now = world.advance(time);
    ASSERT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), expected);
  }
};

TEST(EmptiedWorlds, SleepAndAreFilledAgain) {
  for (const test::AnyMethod method : test::kMethods) {
    for (const int n : {0, 1, 5, 16, 17, 100, 192, 193, 400}) {
      for (const int k : {0, 1, 15, 16, 33, 200}) {
        if (method != test::AnyMethod::events && n + k > 120) continue;
        Resting app({.method = method, .common = {.time_step = kStep}}, static_cast<std::uint64_t>(1000 * n + k));
        int step = 0;
        for (int round = 0; round < 3; ++round) {
          for (int i = 0; i < n; ++i) app.add();
          app.expect_right(kStep * step++);
          for (int i = 0; i < k; ++i) app.add();
          if (round == 1) app.expect_right(kStep * step++);
          app.remove_all();
          app.expect_right(kStep * step++);
          EXPECT_EQ(app.world.size(), 0u);
          if (testing::Test::HasFatalFailure()) FAIL() << static_cast<int>(method) << ", " << n << " and " << k;
        }
        app.world.advance(kStep * (step + 1000));  // whatever was due
        EXPECT_EQ(app.world.next_time(), std::numeric_limits<double>::infinity());
      }
    }
  }
}

// The step before a common expiry updates bodies ahead: at none, if they are all gone by then.
TEST(EmptiedWorlds, SleepThroughWhatWasACommonExpiry) {
  constexpr double kExactStep = 1.0 / 64;
  for (const std::size_t n : {40u, 300u}) {
    for (int emptied = 1; emptied < 14; ++emptied) {
      std::vector<Motion> values(n);
      BroadPhase world(values_of(values), {.time_step = kExactStep});
      std::vector<BodyId> ids;
      for (Motion& motion : values) {
        motion.position = {10.0 * static_cast<double>(ids.size()), 0, 0};
        motion.radius = 1;
        motion.expiry = 12 * kExactStep;
        ids.push_back(world.add());
      }
      for (int step = 0; step < 30; ++step) {
        if (step == emptied) {
          for (const BodyId id : ids) ASSERT_TRUE(world.remove(id));
        }
        for (Motion& motion : values) motion.expiry = step < 11 ? 12 * kExactStep : 40 * kExactStep;
        EXPECT_TRUE(world.advance(kExactStep * step).pairs.empty());
      }
      EXPECT_EQ(world.next_time(), std::numeric_limits<double>::infinity()) << n << ", " << emptied;
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
