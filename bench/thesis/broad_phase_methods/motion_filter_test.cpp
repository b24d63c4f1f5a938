#include "motion_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "worlds.h"

namespace orchard::broad_phase_methods {
namespace {

namespace test = runtime::test;

constexpr double kSamplePeriod = 1.0 / 60, kHorizon = 0.1;
constexpr std::size_t kFine = 12;  // parts of a step in which a path is simulated

std::size_t fine(int step) { return static_cast<std::size_t>(step) * kFine; }

class Noise : public test::Draw {
 public:
  using test::Draw::Draw;
  double normal() { return std::sqrt(-2 * std::log(uniform(1e-300, 1))) * std::cos(uniform(0, 2 * std::numbers::pi)); }
  Vec3 vector(double deviation) { return {deviation * normal(), deviation * normal(), deviation * normal()}; }
};

// A path whose acceleration is a random walk, at `kFine` times a step.
std::vector<Vec3> random_walk(const MotionFilterOptions& options, int steps, Noise& noise) {
  const double h = kSamplePeriod / kFine;
  Vec3 x{}, v = noise.vector(options.max_speed), a = noise.vector(options.max_acceleration);
  std::vector<Vec3> path{x};
  for (std::size_t i = 0; i < fine(steps); ++i) {
    x = x + h * v + (h * h / 2) * a;
    v = v + h * a;
    a = a + noise.vector(std::sqrt(options.jerk_density * h));
    path.push_back(x);
  }
  return path;
}

bool holds(const Motion& motion, double seconds, const Vec3& position) {
  const Vec3 off = position - (motion.position + seconds * motion.velocity);
  const double more = motion.drift * seconds, size = length(motion.half_space);
  if (length(off) > motion.radius + more + motion.acceleration * seconds * seconds / 2) return false;
  return size == 0 || dot(off, motion.half_space) / size <= motion.radius + more;
}

// In how many of `trials` a bound that is asked for after some samples, of which a share is lost, holds to its end.
double share_kept(const MotionFilterOptions& options, double lost, int trials) {
  int kept = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Noise noise(static_cast<std::uint64_t>(trial) + 1);
    const int asked = 3 + static_cast<int>(noise.uniform(0, 30)),
              end = asked + static_cast<int>(kHorizon / kSamplePeriod);
    const auto path = random_walk(options, end, noise);
    MotionFilter filter(options);
    for (int i = 0; i <= asked; ++i) {
      const Vec3 sample = path[fine(i)] + noise.vector(options.noise);
      if (i > 0 && noise.uniform(0, 1) < lost) continue;
      EXPECT_TRUE(filter.add(i * kSamplePeriod, sample));
    }
    const Motion motion = filter.motion(0, asked * kSamplePeriod, kHorizon);
    bool holding = true;
    for (std::size_t i = fine(asked); i <= fine(end); ++i)
      holding = holding && holds(motion, static_cast<double>(i - fine(asked)) * kSamplePeriod / kFine, path[i]);
    kept += holding;
  }
  return static_cast<double>(kept) / trials;
}

TEST(MotionFilter, KeepsItsBoundsAtLeastAsOftenAsStatedThoughSamplesAreLost) {
  for (const double confidence : {0.5, 0.9, 0.99}) {
    for (const double lost : {0.0, 0.4}) {
      const MotionFilterOptions options{
          .noise = 2e-3, .jerk_density = 40, .max_speed = 0.5, .max_acceleration = 4, .confidence = confidence};
      EXPECT_GE(share_kept(options, lost, 3000), confidence) << confidence << ", lost " << lost;
    }
  }
}

TEST(MotionFilter, BreaksBoundsWhereTheMotionIsWilderThanStated) {
  MotionFilterOptions calm{.noise = 2e-3, .jerk_density = 1e-3, .max_speed = 0.5, .max_acceleration = 4};
  Noise noise(1);
  const auto path =
      random_walk({.noise = 2e-3, .jerk_density = 1e4, .max_speed = 0.5, .max_acceleration = 4}, 120, noise);
  MotionFilter filter(calm);
  int broken = 0;
  for (int i = 0; i < 110; ++i) {
    filter.add(i * kSamplePeriod, path[fine(i)] + noise.vector(calm.noise));
    broken += !holds(filter.motion(0, i * kSamplePeriod, kHorizon), 6 * kSamplePeriod, path[fine(i + 6)]);
  }
  EXPECT_GT(broken, 50);
}

TEST(MotionFilter, FindsAConstantAccelerationAndItsHalfSpace) {
  const Vec3 acceleration{0, -9.81, 0};
  MotionFilter filter({.noise = 1e-6, .jerk_density = 1e-6, .max_speed = 10, .max_acceleration = 100});
  for (int i = 0; i <= 60; ++i) {
    const double t = i * kSamplePeriod;
    filter.add(t, (t * t / 2) * acceleration + Vec3{3 * t, 0, 1});
  }
  const Motion motion = filter.motion(0.25, 1, kHorizon);
  EXPECT_NEAR(motion.acceleration, 9.81, 0.05);
  EXPECT_NEAR(motion.velocity[0], 3, 1e-3);
  EXPECT_NEAR(motion.velocity[1], -9.81, 1e-2);
  EXPECT_NEAR(motion.radius, 0.25, 1e-4);
  EXPECT_GT(motion.half_space[1], 0);  // away from where the acceleration may go
  EXPECT_DOUBLE_EQ(motion.expiry, 1 + kHorizon);
}

TEST(MotionFilter, WidensItsBoundsWhileSamplesAreMissingAndWithTheConfidence) {
  const auto bound = [](double confidence, double late) {
    MotionFilter filter({.noise = 1e-3, .jerk_density = 10, .confidence = confidence});
    for (int i = 0; i < 30; ++i) filter.add(i * kSamplePeriod, {0.01 * i, 0, 0});
    return filter.motion(0, 29 * kSamplePeriod + late, kHorizon);
  };
  for (int i = 0; i < 10; ++i) {
    const Motion now = bound(0.9, i * kSamplePeriod), later = bound(0.9, (i + 1) * kSamplePeriod),
                 surer = bound(0.999, i * kSamplePeriod);
    EXPECT_GT(later.radius, now.radius);
    EXPECT_GT(later.drift, now.drift);
    EXPECT_GT(surer.radius, now.radius);
    EXPECT_GT(surer.acceleration, now.acceleration);
  }
}

TEST(MotionFilter, RefusesSamplesThatAreLateOrNotFiniteAndIsTheSameAfterwards) {
  MotionFilter filter, other;
  for (MotionFilter* each : {&filter, &other})
    for (int i = 1; i <= 5; ++i) EXPECT_TRUE(each->add(i, {1.0 * i, 2, 3}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(filter.add(5, {0, 0, 0}));
  EXPECT_FALSE(filter.add(4, {0, 0, 0}));
  EXPECT_FALSE(filter.add(nan, {0, 0, 0}));
  EXPECT_FALSE(filter.add(6, {0, nan, 0}));
  const Motion motion = filter.motion(1, 5, 1), same = other.motion(1, 5, 1);
  EXPECT_EQ(motion.position, same.position);
  EXPECT_EQ(motion.acceleration, same.acceleration);
  EXPECT_TRUE(is_valid(motion));
  filter.reset();
  EXPECT_TRUE(filter.empty());
  EXPECT_TRUE(filter.add(1, {0, 0, 0}));
}

TEST(MotionFilter, TakesNoSampleIfAnOptionIsOutOfItsRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const MotionFilterOptions& options :
       {MotionFilterOptions{.noise = 0}, MotionFilterOptions{.noise = nan}, MotionFilterOptions{.jerk_density = -1},
        MotionFilterOptions{.max_speed = -1}, MotionFilterOptions{.max_acceleration = infinity},
        MotionFilterOptions{.confidence = 0}, MotionFilterOptions{.confidence = 1},
        MotionFilterOptions{.confidence = nan}}) {
    MotionFilter filter(options);
    EXPECT_FALSE(filter.add(1, {0, 0, 0}));
    EXPECT_TRUE(filter.empty());
  }
}

}  // namespace
}  // namespace orchard::broad_phase_methods
