#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "../support/effort.h"
#include "any_broad_phase.h"
#include "orchard/runtime/motion_helpers.h"
#include "runtime/numbers.h"
#include "worlds.h"

// Promises that are not kept are found while a program is being written.
namespace orchard::runtime {
namespace {

using test::kStep;

TEST(MotionBoundExcess, SaysWhichBoundIsBrokenByHowMuch) {
  const Motion bound{.position = {1, 2, 3},
                     .velocity = {4, 0, 0},
                     .radius = 2,
                     .acceleration = 10,
                     .drift = 0.5,
                     .half_space = {0, 0, 7},
                     .expiry = 2};
  constexpr double kSeconds = 0.5;
  const double position = 0.5 * kSeconds + 5 * kSeconds * kSeconds, velocity = 0.75 + 10 * kSeconds;
  const auto moved = [&](const Vec3& by, const Vec3& faster) {
    Motion given = bound;
    given.position = bound.position + kSeconds * bound.velocity + by;
    given.velocity = bound.velocity + faster;
    given.drift = 0.25;
    return given;
  };
  const auto excess = [&](const Motion& given, double time = 1.5) {
    return motion_bound_excess(bound, 1, given, time);
  };
  EXPECT_TRUE(excess(moved({}, {})).none());
  EXPECT_TRUE(excess(moved({0, position, 0}, {0, -velocity, 0})).none());
  MotionBoundExcess by = excess(moved({0, position + 1e-3, 0}, {0, 0, -velocity - 1e-2}));
  EXPECT_NEAR(by.position, 1e-3, 1e-9);
  EXPECT_NEAR(by.velocity, 1e-2, 1e-6);
  EXPECT_EQ(by.side + by.turn + by.radius, 0);
  by = excess(moved({0, 0, 0.5 * kSeconds + 1e-4}, {0, 0, 0.75 + 1e-4}));  // d: not to its side but by the drift
  EXPECT_NEAR(by.side, 1e-4, 1e-9);
  EXPECT_NEAR(by.turn, 1e-4, 1e-7);
  EXPECT_EQ(by.position + by.velocity + by.radius, 0);
  Motion grown = moved({}, {});
  grown.radius = 2.125;
  EXPECT_NEAR(excess(grown).radius, 0.125, 1e-8);
  grown.radius = 1.875;
  EXPECT_NEAR(excess(grown).radius, 0.125, 1e-8);
  const Motion wild = moved({99, 0, 0}, {99, 0, 0});
  EXPECT_FALSE(excess(wild).none());
  EXPECT_TRUE(excess(wild, 2.01).none());  // it has expired
  EXPECT_TRUE(excess(wild, 0.99).none());  // before
  const MotionBoundExcess at_expiry = excess(wild, 2);
  EXPECT_GT(at_expiry.position, 0);
  EXPECT_EQ(at_expiry.velocity, 0);  // it may jump there
  EXPECT_TRUE(motion_bound_excess(bound, 1, moved({0, position + 1e-3, 0}, {}), 1 + kSeconds, 1e-3).none());
}

std::vector<BodyPair> pair_list(const Advance& now) { return {now.pairs.begin(), now.pairs.end()}; }

class Validation : public testing::TestWithParam<test::AnyMethod> {};
INSTANTIATE_TEST_SUITE_P(BroadPhase, Validation, testing::ValuesIn(test::kMethods));

// Frames of any length, bounds that expire together or not, half-spaces: no body is blamed, and nothing is other than
// without.
TEST_P(Validation, FindsNothingWherePromisesAreKept) {
  const bool events = GetParam() == test::AnyMethod::events;
  const std::uint64_t first = orchard::test::first_seed(), seeds = (events ? 60 : 8) * orchard::test::more();
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    test::Draw draw(seed);
    const test::WorldShape shape{.bodies = seed % 10 == 0 ? 250u : 25u,
                                 .ball = draw.uniform(5, 30),
                                 .period = draw.uniform(0.1, 0.6),
                                 .half_spaces = 0.5,
                                 .extreme = seed % 2 == 0,
                                 .staggered = seed % 3 == 0};
    const test::MovingBodies bodies(shape, seed);
    test::AnyOptions options{.method = GetParam(), .common = {.time_step = kStep}};
    if (!events && shape.bodies > 25) continue;
    BroadPhase plain = test::make_broad_phase(bodies.source(), options);
    options.common.validate = true;
    options.common.broken = [&](const MotionBoundViolation& broken) {
      FAIL() << broken.body.index << " at " << broken.time;
    };
    BroadPhase checked = test::make_broad_phase(bodies.source(), options);
    for (std::size_t i = 0; i < bodies.size(); ++i) plain.add(), checked.add();
    const double frame = draw.uniform(0.003, 0.03);
    for (int k = 0; k * frame < 1; ++k) {
      const double t = k * frame;
      for (;;) {
        const Advance now = plain.advance(t), same = checked.advance(t);
        ASSERT_EQ(pair_list(same), pair_list(now));
        ASSERT_EQ(same.time, now.time);
        if (now.pairs.empty()) break;
      }
    }
    EXPECT_EQ(checked.motion_bound_violations(), 0u);
    EXPECT_GE(checked.motions_asked(), plain.motions_asked());
  }
}

// Values that are of a frame at 60 Hz, taken for those of the steps in between: contacts are missed, and others are
// reported that were none. Every such world is found out.
TEST(Validation, FindsValuesThatAreOfTheFrameAndNotOfTheStep) {
  constexpr double kFrame = 1.0 / 60;
  std::size_t touching = 0, missed = 0, wrong = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const test::MovingBodies bodies({.bodies = 60, .ball = 14, .min_radius = 0.1, .max_radius = 0.6, .end = 2}, seed);
    std::vector<Motion> values(bodies.size());
    std::uint64_t heard = 0;
    double worst = 0;
    BroadPhaseOptions options{.time_step = kStep, .validate = true};
    options.broken = [&](const MotionBoundViolation& broken) {
      ++heard;
      EXPECT_FALSE(broken.by.none());
      EXPECT_GE(broken.time, broken.bound_time);
      worst = std::max(worst, broken.by.position);
    };
    BroadPhase world(values_of(values), options);
    for (std::size_t i = 0; i < bodies.size(); ++i) world.add();
    std::vector<BodyPair> reported;
    int step = 0;
    for (int frame = 0; frame <= 120; ++frame) {
      const double t = frame * kFrame;
      for (BodyIndex i = 0; i < bodies.size(); ++i) values[i] = bodies.motion(i, t);
      std::map<int, std::vector<BodyPair>> found;
      for (Advance now = world.advance(t); !now.pairs.empty(); now = world.advance(t)) {
        found[static_cast<int>(std::lround(now.time / kStep))] = pair_list(now);
      }
      for (; step * kStep <= t; ++step) {
        const auto right = bodies.touching(step * kStep);
        std::vector<BodyPair> both;
        std::set_intersection(right.begin(), right.end(), found[step].begin(), found[step].end(),
                              std::back_inserter(both));
        touching += right.size();
        missed += right.size() - both.size();
        wrong += found[step].size() - both.size();
      }
    }
    EXPECT_EQ(heard, world.motion_bound_violations());
    EXPECT_GT(heard, 100u) << seed;
    EXPECT_GT(worst, 0.01);
  }
  std::printf("of %zu overlaps %zu were missed, %zu were none\n", touching, missed, wrong);
  EXPECT_GT(missed, 10u);
}

TEST(Validation, FindsADriftThatIsMissing) {
  for (const bool given : {false, true}) {
    constexpr double kMax = 5;
    std::vector<Motion> values(1);
    values[0].acceleration = kMax;
    values[0].drift = given ? drift_of(Integrator::semi_implicit_euler, kStep, kMax) : 0;
    BroadPhase world(values_of(values), {.time_step = kStep, .validate = true});
    world.add();
    for (int step = 0; step < 100; ++step) {
      world.advance(step * kStep);
      values[0].velocity[2] += kStep * kMax;
      values[0].position = values[0].position + kStep * values[0].velocity;
    }
    EXPECT_EQ(world.motion_bound_violations() > 0, !given);
  }
}

// One body breaks one bound at one step: it is named, once, with the amount.
TEST_P(Validation, NamesTheBodyTheTimeAndTheAmount) {
  enum class Crime { position, velocity, side, turn, radius };
  for (const Crime crime : {Crime::position, Crime::velocity, Crime::side, Crime::turn, Crime::radius}) {
    std::vector<Motion> values(5);
    std::vector<MotionBoundExcess> heard;
    BodyId guilty;
    test::AnyOptions options{.method = GetParam(), .common = {.time_step = kStep, .validate = true}};
    options.common.broken = [&](const MotionBoundViolation& broken) {
      heard.push_back(broken.by);
      EXPECT_EQ(broken.body, guilty);
      EXPECT_NEAR(broken.time, 20 * kStep, 1e-9);
      EXPECT_NEAR(broken.bound_time, 19 * kStep, 1e-9);  // the step before
      EXPECT_EQ(broken.bound.acceleration, 1);
      EXPECT_EQ(broken.given.radius, values[3].radius);
    };
    BroadPhase world = test::make_broad_phase(values_of(values), options);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i].position = {100.0 * static_cast<double>(i), 0, 0};
      values[i].half_space = {0, 0, 1};
      values[i].radius = values[i].acceleration = 1;
      const BodyId id = world.add();
      if (i == 3) guilty = id;
    }
    for (int step = 0; step < 40; ++step) {
      if (step == 20) {
        Motion& m = values[3];
        if (crime == Crime::position) m.position[1] += 0.25;
        if (crime == Crime::velocity) m.velocity[1] += 0.25;
        if (crime == Crime::side) m.position[2] += 1e-5;
        if (crime == Crime::turn) m.velocity[2] += 1e-3;
        if (crime == Crime::radius) m.radius += 0.25;
      } else if (step > 20) {
        values[3].position = values[3].position + kStep * values[3].velocity;
      }
      world.advance(step * kStep);
    }
    ASSERT_EQ(heard.size(), 1u) << static_cast<int>(crime);
    const MotionBoundExcess& by = heard[0];
    EXPECT_NEAR(by.position, crime == Crime::position ? 0.25 - kStep * kStep / 2 : 0, 1e-6);
    EXPECT_NEAR(by.velocity, crime == Crime::velocity ? 0.25 - kStep : 0, 1e-6);
    EXPECT_NEAR(by.side, crime == Crime::side ? 1e-5 : 0, 1e-8);
    EXPECT_NEAR(by.turn, crime == Crime::turn ? 1e-3 : 0, 1e-6);
    EXPECT_NEAR(by.radius, crime == Crime::radius ? 0.25 : 0, 1e-6);
  }
}

// What the application says in time is no crime; and who takes an index over does not inherit.
TEST_P(Validation, ForgivesWhatIsCancelled) {
  test::Draw draw(3);
  std::vector<Motion> values(30);
  test::AnyOptions options{.method = GetParam(), .common = {.time_step = kStep, .validate = true}};
  BroadPhase world = test::make_broad_phase(values_of(values), options);
  for (Motion& m : values) {
    m = {.position = draw.in_ball(20), .velocity = draw.direction(), .radius = 0.5};
    world.add();
  }
  for (int step = 0; step < 100; ++step) {
    for (Motion& m : values) m.position = m.position + kStep * m.velocity;
    const auto body = static_cast<BodyIndex>(draw.bits() % values.size());
    const BodyId id = world.id_of(body);
    values[body].position = draw.in_ball(20);
    values[body].velocity = 9.0 * draw.direction();
    if (step % 3 == 0) {
      ASSERT_TRUE(world.teleport(id));
    } else if (step % 3 == 1) {
      ASSERT_TRUE(world.remove(id));
      ASSERT_EQ(world.add().index, body);
    } else {  // refused for a while: nothing relied on what it said
      const Motion good = values[body];
      values[body].radius = -1;
      world.advance(step * kStep);
      ASSERT_TRUE(world.cancel(id));
      values[body] = good;
    }
    world.advance(step * kStep);
    ASSERT_EQ(world.motion_bound_violations(), 0u) << step;
  }
  for (Motion& m : values) m.position = m.position + kStep * m.velocity;
  values[0].position[0] += length(values[0].velocity) + 1;
  world.advance(1);
  EXPECT_EQ(world.motion_bound_violations(), 1u);
}

// A looser promise does not take back a stricter one that is still in force.
TEST(Validation, HoldsOnToTheStricterPromise) {
  std::vector<Motion> values(1);
  values[0].acceleration = 1;
  values[0].expiry = 0.5;
  BroadPhase world(values_of(values), {.time_step = kStep, .validate = true});
  world.add();
  world.advance(0);
  values[0].acceleration = 1000;  // that it will need after 0.5 s
  values[0].expiry = 2;
  world.advance(kStep);
  EXPECT_EQ(world.motion_bound_violations(), 0u);
  values[0].velocity = {5, 0, 0};  // allowed by the second, not by the first
  world.advance(2 * kStep);
  EXPECT_EQ(world.motion_bound_violations(), 1u);
}

}  // namespace
}  // namespace orchard::runtime
