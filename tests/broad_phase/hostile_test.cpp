#include <gtest/gtest.h>

#include <cmath>

#include "any_broad_phase.h"
#include "runtime/every_machine.h"
#include "runtime/numbers.h"
#include "worlds.h"

// Values that are none: refused, and said to be.
namespace orchard::runtime {
namespace {

using test::kInfinity;
using test::kNaN;
using test::kStep;

std::vector<BodyIndex> refused_by(const Advance& now) { return {now.refused.begin(), now.refused.end()}; }

TEST(HostileTimes, AreRefusedAndChangeNothing) {
  for (const test::AnyMethod method : test::kMethods) {
    std::vector<Motion> values(3);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i].position = {static_cast<double>(i), 0, 0};
      values[i].velocity = {1, 0, 0};
      values[i].radius = 0.6;
      values[i].expiry = 0.5;
    }
    BroadPhase world = test::make_broad_phase(values_of(values), {.method = method, .common = {.time_step = kStep}});
    const auto refuses = [&](double t) {
      const double next = world.next_time();
      const std::uint64_t asked = world.motions_asked();
      for (const Advance& now : {world.advance(t), world.advance(t, Budget{.work = 5})}) {
        EXPECT_TRUE(now.time_refused) << t;
        EXPECT_EQ(now.time, next);
        EXPECT_TRUE(now.pairs.empty());
      }
      EXPECT_EQ(world.motions_asked(), asked);
    };
    const double hostile[] = {kNaN, kInfinity, -kInfinity, 1e300, -1e300, 1.01 * kMaxSteps * kStep};
    for (const double t : hostile) refuses(t);  // of an empty world, which sleeps for ever
    for (std::size_t i = 0; i < values.size(); ++i) world.add();
    for (const double t : hostile) refuses(t);
    EXPECT_FALSE(world.advance(0).time_refused);
    EXPECT_EQ(world.advance(kStep).pairs.size(), 2u);
    for (const double t : hostile) refuses(t);
    EXPECT_EQ(world.advance(2 * kStep).pairs.size(), 2u);
  }
}

TEST(HostileTimes, FarAwayAreTimesLikeOthers) {
  for (const double start : {-0.9 * kMaxSteps * kStep, 0.9 * kMaxSteps * kStep}) {
    std::vector<Motion> values(2);
    for (Motion& motion : values) motion.radius = 1;
    BroadPhase world(values_of(values), {.time_step = kStep, .start = start});
    world.add(), world.add();
    EXPECT_TRUE(world.valid());
    EXPECT_EQ(world.advance(start).pairs.size(), 1u);
    EXPECT_EQ(world.advance(start + 3 * kStep).pairs.size(), 1u);
  }
}

TEST(HostileOptions, MakeAWorldThatRefusesEverything) {
  std::vector<Motion> values(1);
  BroadPhaseOptions good{.time_step = 1e-20};
  EXPECT_TRUE(is_valid(good));
  std::vector<BroadPhaseOptions> bad;
  for (const double step : {0.0, -0.01, kNaN, kInfinity, -kInfinity, 1e-300, 1e300}) bad.push_back({.time_step = step});
  for (const double start : {kNaN, kInfinity, -kInfinity, 1e300, 1.01 * kMaxSteps * kStep}) {
    bad.push_back({.time_step = kStep, .start = start});
  }
  for (const BroadPhaseOptions& options : bad) {
    EXPECT_FALSE(is_valid(options));
    for (const test::AnyMethod method : test::kMethods) {
      BroadPhase world = test::make_broad_phase(values_of(values), {.method = method, .common = options});
      EXPECT_FALSE(world.valid());
      EXPECT_EQ(world.add(), kNoBody);
      EXPECT_EQ(world.add_static(Motion{}), kNoBody);
      EXPECT_TRUE(world.advance(0).time_refused);
      EXPECT_EQ(world.size(), 0u);
    }
  }
}

TEST(HostileOptions, WithoutASourceThereAreStaticBodiesOnly) {
  BroadPhase world({}, {});
  EXPECT_EQ(world.add(), kNoBody);
  EXPECT_NE(world.add_static(Motion{}), kNoBody);
}

std::vector<Motion> invalid_motions() {
  Motion good;
  good.radius = 1;
  std::vector<Motion> all;
  const auto with = [&](auto&& spoil) {
    all.push_back(good);
    spoil(all.back());
  };
  for (const double x : {kNaN, kInfinity, -kInfinity, 1e101, -1e300}) {
    for (std::size_t d = 0; d < 3; ++d) {
      with([&](Motion& m) { m.position[d] = x; });
      with([&](Motion& m) { m.velocity[d] = x; });
      with([&](Motion& m) { m.half_space[d] = x; });
    }
    with([&](Motion& m) { m.radius = x; });
    with([&](Motion& m) { m.acceleration = x; });
    with([&](Motion& m) { m.drift = x; });
  }
  for (const double x : {-1e-300, -1.0}) {
    with([&](Motion& m) { m.radius = x; });
    with([&](Motion& m) { m.acceleration = x; });
    with([&](Motion& m) { m.drift = x; });
  }
  with([&](Motion& m) { m.expiry = kNaN; });
  return all;
}

// Among n bodies in a row, each of which touches the next, one is invalid for some steps.
TEST(HostileMotions, AreRefusedAndReportedUntilTheyAreValid) {
  for (const test::AnyMethod method : test::kMethods) {
    for (const std::size_t n : {3u, 9u, 250u}) {
      if (method != test::AnyMethod::events && n > 9) continue;
      for (const bool portable : {false, true}) {
        const auto machine = test::on_portable_machine(portable);
        for (const Motion& bad : invalid_motions()) {
          std::vector<Motion> values(n);
          BroadPhase world =
              test::make_broad_phase(values_of(values), {.method = method, .common = {.time_step = kStep}});
          for (std::size_t i = 0; i < n; ++i) {
            values[i].position = {1.5 * static_cast<double>(i), 0, 0};
            values[i].radius = 1;
            if (i % 3 == 0) values[i].expiry = 0.02;
            world.add();
          }
          const Motion good = values[1];
          ASSERT_FALSE(is_valid(bad));
          values[1] = bad;  // from the start
          for (int step = 0; step < 9; ++step) {
            if (step == 3) values[1] = good;
            if (step == 6) {
              values[1] = bad;
              ASSERT_TRUE(world.cancel(world.id_of(1)));
            }
            for (std::size_t i = 0; i < n; ++i) {
              if (i != 1 && i % 3 == 0) values[i].expiry = kStep * (step + 2);
            }
            const bool out = step < 3 || step >= 6;
            const Advance now = world.advance(kStep * step);
            ASSERT_EQ(now.pairs.size(), out ? n - 3 : n - 1) << static_cast<int>(method) << " step " << step;
            for (const BodyPair& pair : now.pairs) ASSERT_FALSE(out && (pair.a == 1 || pair.b == 1));
            ASSERT_EQ(refused_by(now), out ? std::vector<BodyIndex>{1} : std::vector<BodyIndex>{}) << step;
          }
        }
      }
    }
  }
}

// A body that breaks its word without a cancel is found out when the next pair with it is tested.
TEST(HostileMotions, BetweenTwoLooksAreFoundAtThePairsTest) {
  std::vector<Motion> values(2);
  for (Motion& motion : values) {
    motion.radius = 1;
    motion.acceleration = 1e3;  // how long the overlap lasts is not known
  }
  values[1].position = {1.9, 0, 0};
  BroadPhase world(values_of(values), {.time_step = kStep});
  world.add(), world.add();
  EXPECT_EQ(world.advance(0).pairs.size(), 1u);
  EXPECT_EQ(world.advance(kStep * 5).pairs.size(), 1u);
  values[1].radius = -1;
  Advance now = world.advance(kStep * 10);
  while (now.time <= kStep * 10 && now.refused.empty()) now = world.advance(kStep * 10);
  EXPECT_EQ(refused_by(now), std::vector<BodyIndex>{1});
  values[1].radius = 1;
  EXPECT_EQ(world.advance(kStep * 11).pairs.size(), 1u);
}

TEST(HostileMotions, AllAtOnceLeaveAWorldThatRecovers) {
  for (const test::AnyMethod method : test::kMethods) {
    const std::size_t n = method == test::AnyMethod::events ? 400 : 30;
    std::vector<Motion> values(n);
    BroadPhase world = test::make_broad_phase(values_of(values), {.method = method, .common = {.time_step = kStep}});
    for (Motion& motion : values) {
      motion.radius = kNaN;
      world.add();
    }
    for (int step = 0; step < 5; ++step) {
      const Advance now = world.advance(kStep * step);
      EXPECT_TRUE(now.pairs.empty());
      EXPECT_EQ(now.refused.size(), n);
    }
    for (std::size_t i = 0; i < n; ++i) {
      values[i].position = {1.5 * static_cast<double>(i), 0, 0};
      values[i].radius = 1;
    }
    const Advance now = world.advance(kStep * 5);
    EXPECT_EQ(now.pairs.size(), n - 1);
    EXPECT_TRUE(now.refused.empty());
  }
}

// The largest and the smallest numbers that are allowed, all together, at the extreme time steps.
TEST(HostileMotions, AtTheEndsOfTheRangeAreStillAnsweredRight) {
  const double sizes[] = {0, 1e-300, 1e-100, 1e-20, 1, 1e20, 1e99, kMaxNumber};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    test::Draw draw(seed);
    const auto any = [&] { return sizes[draw.bits() % 8]; };
    std::vector<Motion> values(20);
    for (Motion& m : values) {
      m.position = any() * draw.direction();
      m.velocity = any() * draw.direction();
      m.radius = any();
      m.acceleration = any();
      m.drift = any();
      if (draw.bits() % 2 == 0) m.half_space = any() * draw.direction();
      const double expiries[] = {kInfinity, -kInfinity, 0, 1e300, -1e300, 1};
      m.expiry = expiries[draw.bits() % 6];
    }
    const double steps[] = {1e-20, 1e-3, 1, 1e20};
    for (const test::AnyMethod method : test::kMethods) {
      for (const double step : steps) {
        BroadPhase world = test::make_broad_phase(values_of(values), {.method = method, .common = {.time_step = step}});
        for (std::size_t i = 0; i < values.size(); ++i) world.add();
        std::vector<BodyPair> expected;
        for (BodyIndex i = 0; i < values.size(); ++i) {
          for (BodyIndex j = i + 1; j < values.size(); ++j) {
            if (spheres_touch(values[i], values[j])) expected.push_back({i, j});
          }
        }
        const Advance now = world.advance(0);
        ASSERT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), expected)
            << "seed " << seed << " method " << static_cast<int>(method) << " step " << step;
      }
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
