#include <gtest/gtest.h>

#include <cmath>

#include "orchard/runtime/detector.h"
#include "orchard/runtime/frame_pacer.h"
#include "orchard/runtime/motion_monitor.h"
#include "runtime/numbers.h"
#include "support.h"

namespace orchard::runtime {
namespace {

using Duration = FramePacer::Duration;
using test::kStep;

Motion bounded(const Vec3& place, const Vec3& velocity, double acceleration, const Vec3& half_space = {},
               double drift = 0) {
  Motion motion;
  motion.position = place, motion.velocity = velocity;
  motion.acceleration = acceleration, motion.drift = drift;
  motion.half_space = half_space;
  return motion;
}

TEST(MotionMonitor, TellsPromisesThatAreKeptFromThoseThatAreBroken) {
  const Vec3 v = {1, 2, 3}, a = {0, 0, -10};
  for (const double factor : {0.999, 1.001}) {
    MotionMonitor monitor;
    monitor.note_bound(0, 0, bounded({}, v, 10 / factor));
    bool kept = true;
    for (int i = 1; i < 20; ++i) {
      const double t = i * kStep;
      kept = kept && monitor.observe(0, t, t * v + (t * t / 2) * a, v + t * a);
    }
    EXPECT_EQ(kept, factor < 1);
    EXPECT_EQ(monitor.broken(), factor < 1 ? 0u : 1u);  // once: it is void then
    EXPECT_EQ(monitor.broken(0), monitor.broken());
  }
  for (const double side : {1.0, -1.0}) {
    MotionMonitor monitor;
    monitor.note_bound(5, 1, bounded({}, v, 20, {0, 0, side}));
    EXPECT_EQ(monitor.observe(5, 1.5, 0.5 * v + 0.125 * a), side > 0);
  }
  MotionMonitor monitor;
  Motion short_one = bounded({}, v, 0);
  short_one.expiry = 1;
  monitor.note_bound(0, 0, short_one);
  EXPECT_TRUE(monitor.observe(0, 1.5, {99, 99, 99}));  // nothing is promised at this moment
  monitor.note_bound(0, 2, bounded({}, v, 1));
  EXPECT_FALSE(monitor.observe(0, 2.1, 0.1 * v, {2, 2, 3}));  // the place is right, the velocity is not
}

// Thrown bodies and bodies on circles, by positions alone and with velocities: what is suggested is kept, and not much
// larger than what is needed.
TEST(MotionMonitor, SuggestsWhatIsKept) {
  for (const bool with_velocity : {false, true}) {
    for (const bool circle : {false, true}) {
      const auto place = [&](double t) {
        return circle ? Vec3{3 * std::cos(t), 3 * std::sin(t), 0} : Vec3{2 * t, 0, 5 * t - 5 * t * t};
      };
      const auto velocity = [&](double t) {
        return circle ? Vec3{-3 * std::sin(t), 3 * std::cos(t), 0} : Vec3{2, 0, 5 - 10 * t};
      };
      MotionMonitor monitor;
      bool half_space = false;
      for (int i = 0; i < 300; ++i) {
        const double t = i * kStep;
        EXPECT_TRUE(with_velocity ? monitor.observe(1, t, place(t), velocity(t)) : monitor.observe(1, t, place(t)));
        const Motion motion = monitor.suggest(1, t, 0.5);
        EXPECT_EQ(motion.radius, 0.5);
        EXPECT_TRUE(is_valid(motion));
        if (i < 3) continue;
        const double truth = circle ? 3 : 10;
        EXPECT_GE(motion.acceleration, truth * (1 - 1e-3));
        EXPECT_LE(motion.acceleration, 1.6 * truth);
        EXPECT_GT(motion.expiry, t);
        half_space = half_space || dot(motion.half_space, motion.half_space) > 0;
        if (i % 7 == 0) monitor.note_bound(1, t, motion);
      }
      EXPECT_EQ(monitor.broken(), 0u) << with_velocity << circle;
      EXPECT_TRUE(half_space);
    }
  }
}

TEST(MotionMonitor, ShortensTheHorizonOfWhoBreaksPromises) {
  MotionMonitor monitor;
  test::Draw draw(3);
  Vec3 place{}, velocity{};
  double calm = 0, wild = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = i * kStep;
    if (i >= 1000 && i % 5 == 0) velocity = velocity + draw.uniform(1, 30) * Vec3(draw.direction());
    place = place + kStep * velocity;
    monitor.observe(0, t, place, velocity);
    const Motion motion = monitor.suggest(0, t, 1);
    if (i == 999) calm = motion.expiry - t;
    if (i == 1999) wild = motion.expiry - t;
    monitor.note_bound(0, t, motion);
  }
  EXPECT_GT(calm, 0.9);
  EXPECT_LT(wild, 0.3);
  EXPECT_GT(monitor.broken(), 5u);
}

// A body that promises to fly straight, and turns: without the monitor it is missed, with it it is found at once, and
// named.
TEST(MotionMonitor, KeepsADetectorFromMissingAContactThatABrokenPromiseHides) {
  for (const bool watch : {false, true}) {
    std::vector<BodyState> states(2);
    Detector detector(states_of(states), {.time_step = kStep, .watch = watch});
    const ShapeId ball = detector.add_sphere(1);
    const BodyId a = detector.add_body({{ball, {}}}), b = detector.add_body({{ball, {}}});
    states[b.index].pose.translation = {20, 0, 0};
    bool found = false;
    std::size_t named = 0;
    for (int i = 0; i < 200; ++i) {
      const double x = i < 50 ? 20 : std::max(1.5, 20 - 0.3 * (i - 50));  // it had promised to stay
      states[b.index].pose.translation = {x, 0, 0};
      const Frame frame = detector.step(i * kStep);
      found = found || !frame.events.empty();
      if (x <= 2 && watch) {
        EXPECT_TRUE(found) << i;
      }
      for (const BodyIndex broken : frame.broken) named += broken == b.index;
    }
    EXPECT_EQ(found, watch);
    EXPECT_EQ(named > 0, watch);
    EXPECT_EQ(detector.motion_bound_violations(b), named);
    EXPECT_EQ(detector.motion_bound_violations(a), 0u);
  }
}

TEST(MotionMonitor, NoticesBodiesThatGrowAndBulletsThatAreTooFast) {
  std::vector<BodyState> states(3);
  Detector detector(states_of(states), {.time_step = kStep, .watch = true});
  const ShapeId ball = detector.add_sphere(1);
  const BodyId grows = detector.add_body({{ball, {}}});
  const BodyId bullet = detector.add_body({{ball, {}}}, {.continuous_speed = 10});
  states[bullet.index].pose.translation = {50, 0, 0};
  states[bullet.index].expiry = 0;
  detector.step(0);
  states[grows.index].pose.scale = 2;
  states[bullet.index].pose.translation = {50.2, 0, 0};
  const Frame frame = detector.step(kStep);
  ASSERT_EQ(frame.broken.size(), 2u);
  EXPECT_TRUE(detector.step(2 * kStep).broken.empty());
}

// A frame of 16 ms, whose rest takes 6 ms, a little more or less, and now and then half as much again.
TEST(FramePacer, KeepsMoreFramesInTimeThanTheLastFramesTimeDoes) {
  test::Draw draw(5);
  const auto ms = [](double value) { return Duration(static_cast<std::int64_t>(value * 1e6)); };
  FramePacer pacer(ms(16));
  FramePacer::Time now{};
  std::uint64_t late_by_last = 0;
  double last = 6, detection = 0, granted_by_last = 0;
  for (int i = 0; i < 5000; ++i) {
    const double before = draw.uniform(2, 3);
    const double rest = 6 + draw.uniform(-1, 1) + (draw.uniform(0, 1) < 0.02 ? 3 : 0);
    pacer.begin_frame(now);
    now += ms(before);
    const Duration granted = pacer.begin_detection(now);
    const double spent = std::max(0.0, static_cast<double>(granted.count()) * 1e-6);
    detection += spent;
    granted_by_last += 16 - before - last;
    now += ms(spent);  // it uses what it gets
    pacer.end_detection(now);
    now += ms(rest);
    pacer.end_frame(now);
    EXPECT_EQ(pacer.slack() < Duration(0), before + spent + rest > 16 + 1e-5);
    late_by_last += before + (16 - before - last) + rest > 16;
    last = rest;
  }
  EXPECT_LT(pacer.late(), 100u);                // 2 %: the bursts
  EXPECT_GT(late_by_last, 2000u);               // one of two
  EXPECT_GT(detection, 0.6 * granted_by_last);  // and that is not bought by doing nothing
}

TEST(FramePacer, TakesWhatDetectionExceedsIntoAccount) {
  FramePacer pacer(std::chrono::milliseconds(10));
  FramePacer::Time now{};
  for (int i = 0; i < 400; ++i) {
    pacer.begin_frame(now);
    const Duration granted = pacer.begin_detection(now);
    now += granted + std::chrono::microseconds(300);
    pacer.end_detection(now);
    now += std::chrono::milliseconds(2);
    pacer.end_frame(now);
  }
  EXPECT_LT(pacer.late(), 30u);
  EXPECT_GT(pacer.granted(), std::chrono::milliseconds(7));
  EXPECT_EQ(pacer.frames(), 400u);
}

}  // namespace
}  // namespace orchard::runtime
