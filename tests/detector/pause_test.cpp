#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "orchard/runtime/detector.h"
#include "runtime/numbers.h"
#include "support.h"
#include "support/effort.h"

// A long time between two calls of step(): what it costs, and what is left out.
namespace orchard::runtime {
namespace {

using test::kStep;
using Pairs = std::set<std::pair<BodyIndex, BodyIndex>>;

// Balls on circles, so that where each is at any time, and what can be promised of it, is known in closed form.
struct Carousel {
  struct Rider {
    BodyId id;
    Vec3 middle{};
    double reach = 0, speed = 0, phase = 0, radius = 0;
    double x(double time) const { return middle[0] + reach * std::cos(phase + speed * time); }
    double y(double time) const { return middle[1] + reach * std::sin(phase + speed * time); }
  };

  Carousel(std::uint64_t seed, std::size_t count) : draw(seed), riders(count) {
    for (Rider& rider : riders) {
      rider.middle = {draw.uniform(-4, 4), draw.uniform(-4, 4), draw.uniform(-1, 1)};
      rider.reach = draw.uniform(0, 4), rider.speed = draw.uniform(-2, 2), rider.phase = draw.uniform(0, 6);
      rider.radius = draw.uniform(0.2, 0.6);
    }
  }
  Detector detector(DetectorOptions options) {
    options.time_step = kStep;
    Detector world(source(), options);
    for (Rider& rider : riders) rider.id = world.add_body({{world.add_sphere(rider.radius)}});
    return world;
  }
  StateSource source() {
    return [this](double time, std::span<const BodyIndex> bodies, std::span<BodyState> states) {
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Rider& rider = riders[bodies[i]];
        const double x = rider.x(time), y = rider.y(time);
        states[i] = {};
        states[i].pose.translation = {x, y, rider.middle[2]};
        states[i].velocity = {-rider.speed * (y - rider.middle[1]), rider.speed * (x - rider.middle[0]), 0};
        states[i].acceleration = rider.speed * rider.speed * rider.reach * (1 + 1e-6) + 1e-9;
        states[i].drift = 1e-9;
      }
    };
  }
  Pairs touching(double time, Pairs& unsure) const {
    Pairs found;
    for (const Rider& a : riders) {
      for (const Rider& b : riders) {
        if (!(a.id.index < b.id.index)) continue;
        const long double x = static_cast<long double>(a.x(time)) - b.x(time),
                          y = static_cast<long double>(a.y(time)) - b.y(time),
                          z = static_cast<long double>(a.middle[2]) - b.middle[2];
        const long double gap = std::sqrt(x * x + y * y + z * z) - a.radius - b.radius;
        if (std::fabs(gap) < 1e-9L) unsure.insert({a.id.index, b.id.index});
        if (gap <= 0) found.insert({a.id.index, b.id.index});
      }
    }
    return found;
  }

  test::Draw draw;
  std::vector<Rider> riders;
};

// Touching pairs, as events say them: from those of before.
void follow(const Frame& frame, Pairs& touching) {
  for (const PairEvent& event : frame.events) {
    const std::pair<BodyIndex, BodyIndex> pair = {event.a.index, event.b.index};
    ASSERT_NE(event.change, PairChange::possible);
    ASSERT_EQ(touching.count(pair), event.change == PairChange::begin ? 0u : 1u);
    if (event.change == PairChange::begin) touching.insert(pair);
    if (event.change == PairChange::end) touching.erase(pair);
  }
}

TEST(Pauses, AreLeftOutWhereOnlyTheLatestStepIsWanted) {
  std::size_t touches = 0;
  for (std::uint64_t i = 0; i < 30 * orchard::test::more(); ++i) {
    Carousel all(orchard::test::first_seed() + i, 4 + i % 3 * 20);
    Detector world = all.detector({.watch = i % 2 == 0});
    Pairs known;
    std::int64_t step = -1;
    for (int call = 0; call < 20; ++call) {
      const auto pause = static_cast<std::int64_t>(std::exp(all.draw.uniform(0, 11)));  // up to ten minutes
      step += pause;
      const double time = static_cast<double>(step) * kStep;
      const StepOptions latest_only{.latest_only = true};
      const Frame frame = world.step(time, {}, latest_only);
      ASSERT_EQ(frame.unfinished.skipped, static_cast<std::uint64_t>(pause - 1));
      ASSERT_EQ(frame.unfinished.steps_left, 0u);
      ASSERT_LE(frame.steps, 1u);
      ASSERT_NEAR(frame.time, time, 1e-9);
      ASSERT_LE(frame.motions_asked, 4 * all.riders.size() * all.riders.size());
      follow(frame, known);
      if (testing::Test::HasFatalFailure()) return;
      Pairs unsure;
      Pairs truth = all.touching(time, unsure);
      for (const auto& pair : unsure) truth.erase(pair), known.erase(pair);
      ASSERT_EQ(known, truth) << "seed " << i << ", step " << step;
      touches += truth.size();
      known = truth;
      if (!unsure.empty()) break;
    }
  }
  EXPECT_GT(touches, 100u);
}

TEST(Pauses, OfNoLengthAreNothingSpecial) {
  Carousel all(1, 20), same(1, 20);
  Detector latest = all.detector({}), each = same.detector({});
  for (int step = 0; step < 200; ++step) {
    const StepOptions latest_only{.latest_only = true};
    const Frame frame = latest.step(step * kStep, {}, latest_only), other = each.step(step * kStep);
    ASSERT_EQ(frame.unfinished.skipped, 0u);
    ASSERT_EQ(frame.events.size(), other.events.size());
    ASSERT_EQ(frame.work, other.work);
  }
}

TEST(Pauses, OfADetectorThatKeepsTheStatesEndWhereBodiesAreThen) {
  Detector world(DetectorOptions{.time_step = kStep});
  const ShapeId ball = world.add_sphere(1);
  const BodyId a = world.add_body(ball, {.velocity = {1, 0, 0}});
  world.add_static({{ball}}, {.translation = {600, 0, 0}});
  world.add_half_space({-1, 0, 0}, -10'000);
  world.step(0);
  const StepOptions latest_only{.latest_only = true};
  Frame frame = world.step(600, {}, latest_only);
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].change, PairChange::begin);
  EXPECT_NEAR(world.state(a).pose.translation[0], 600, 1e-6);
  world.set_velocity(a, {-1, 0, 0});
  frame = world.step(700, {}, latest_only);
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].change, PairChange::end);
  world.set_velocity(a, {100, 0, 0});
  frame = world.step(800, {}, latest_only);
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].b.index, 0xf0000000u);
}

// The same events as in one call, some at a time.
TEST(Pauses, GiveNoMoreEventsAtOnceThanTheOptionsSay) {
  for (std::uint64_t i = 0; i < 8 * orchard::test::more(); ++i) {
    const std::uint64_t seed = orchard::test::first_seed() + i;
    Carousel all(seed, 30), same(seed, 30);
    const std::size_t most = 1 + all.draw.bits() % 300;
    Detector world = all.detector({.watch = i % 2 == 0, .max_events = most});
    Detector whole = same.detector({.watch = i % 2 == 0});
    const double time = 500 * kStep;
    const Frame expected = whole.step(time);
    ASSERT_EQ(expected.unfinished.steps_left, 0u);
    std::size_t next = 0, at_once = 0;
    std::uint32_t steps = 0;
    for (std::uint64_t left = 1; left > 0;) {
      const Frame frame = world.step(time);
      left = frame.unfinished.steps_left;
      ASSERT_TRUE(left == 0 || frame.events.size() >= most);
      steps += frame.steps;
      for (const PairEvent& event : frame.events) {
        ASSERT_LT(next, expected.events.size());
        const PairEvent& other = expected.events[next++];
        ASSERT_EQ(event.change, other.change);
        ASSERT_EQ(event.a, other.a);
        ASSERT_EQ(event.b, other.b);
        ASSERT_EQ(event.time, other.time);
      }
      at_once = std::max(at_once, frame.events.size());
    }
    EXPECT_EQ(next, expected.events.size());
    EXPECT_EQ(steps, expected.steps);
    EXPECT_LT(at_once, most + 30 * 29 / 2);
  }
  EXPECT_FALSE(Detector(DetectorOptions{.max_events = 0}).valid());
}

TEST(Pauses, TakeNoMoreMemoryThanTheOptionsSay) {
  Carousel all(3, 30);
  for (Carousel::Rider& rider : all.riders) rider.speed = 0, rider.reach = 0;
  Detector world = all.detector({.watch = false, .max_events = 2000});
  world.step(0);
  const std::size_t before = world.memory_bytes();
  std::uint64_t left = 1;
  std::size_t events = 0;
  for (int call = 0; call < 5; ++call) {
    const Frame frame = world.step(600);
    left = frame.unfinished.steps_left;
    events += frame.events.size();
  }
  EXPECT_GT(left, 0u);
  EXPECT_GE(events, 10'000u);
  EXPECT_LT(world.memory_bytes() - before, 2 * (2000 + 30 * 29 / 2) * sizeof(PairEvent));
}

}  // namespace
}  // namespace orchard::runtime
