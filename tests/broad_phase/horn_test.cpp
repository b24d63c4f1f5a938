#include "broad_phase/horn.h"

#include <gtest/gtest.h>

#include <cmath>

#include "worlds.h"

namespace orchard::runtime {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

Motion at(const Vec3& position, const Vec3& velocity, double radius, double acceleration) {
  Motion motion;
  motion.position = position;
  motion.velocity = velocity;
  motion.radius = radius;
  motion.acceleration = acceleration;
  return motion;
}

TEST(HornContact, OfPointsClosingAtConstantSpeedIsDistanceOverSpeed) {
  EXPECT_NEAR(earliest_contact(at({0, 0, 0}, {1, 0, 0}, 0.5, 0), at({10, 0, 0}, {-1, 0, 0}, 0.5, 0), 10, 0), 4.5, 1e-9);
}

TEST(HornContact, OfBodiesAtRestIsWhereTheHornsMeet) {  // two radii of t^2: 8 = 2 t^2
  EXPECT_NEAR(earliest_contact(at({0, 0, 0}, {}, 1, 2), at({10, 0, 0}, {}, 1, 2), 10, 0), 2, 1e-9);
}

TEST(HornContact, HandlesDegenerateCases) {
  EXPECT_EQ(earliest_contact(at({1, 2, 3}, {1, 0, 0}, 0, 0), at({1, 2, 3}, {1, 0, 0}, 0, 0), 1, 0),
            0);  // coincident points
  EXPECT_EQ(earliest_contact(at({0, 0, 0}, {1, 2, 3}, 1, 0), at({3, 0, 0}, {1, 2, 3}, 1, 0), 1e6, 0),
            kNever);                                                                       // same velocity
  EXPECT_EQ(earliest_contact(at({0, 0, 0}, {}, 1, 0), at({2, 0, 0}, {}, 1, 0), 1, 0), 0);  // touching
  EXPECT_EQ(earliest_contact(at({0, 0, 0}, {-1, 0, 0}, 1, 0), at({3, 0, 0}, {1, 0, 0}, 1, 0), 1e6, 0),
            kNever);                                                                                      // parting
  EXPECT_NEAR(earliest_contact(at({0, 0, 0}, {1, 0, 0}, 0, 0), at({1, 0, 0}, {}, 0, 0), 2, 0), 1, 1e-9);  // zero radii
}

TEST(HornContact, GrazingIsFoundNotMissed) {  // passing at exactly the sum of radii
  const double t = earliest_contact(at({-5, 2, 0}, {1, 0, 0}, 1, 0), at({0, 0, 0}, {}, 1, 0), 20, 1e-12);
  EXPECT_NEAR(t, 5, 1e-4);
  EXPECT_LE(t, 5);
}

TEST(HornContact, AHalfSpacePutsItOff) {
  Motion a = at({0, 0, 0}, {}, 1, 2);
  const Motion b = at({10, 0, 0}, {}, 1, 0);
  const double free = earliest_contact(a, b, 100, 0);
  EXPECT_NEAR(free, std::sqrt(8.0), 1e-6);
  a.half_space = {3, 0, 0};  // accelerates away from b only
  EXPECT_EQ(earliest_contact(a, b, 100, 0), kNever);
  a.half_space = {-3, 0, 0};
  EXPECT_EQ(earliest_contact(a, b, 100, 0), free);
}

TEST(HornContact, OfASpeedBoundIsWhereTheBallsMeet) {
  const Motion a = speed_bounded({0, 0, 0}, 1, 2, 10), b = speed_bounded({10, 0, 0}, 1, 2, 10);
  EXPECT_NEAR(earliest_contact(a, b, 10, 0), 2, 1e-9);
}

// Against sampling: never after the first time at which the horns meet, and not before they nearly do.
TEST(HornContact, AgreesWithSampling) {
  test::Draw draw(1);
  int meeting = 0;
  for (int trial = 0; trial < 8000; ++trial) {
    const Motion a = at(draw.in_ball(10), 8 * draw.direction(), draw.uniform(0, 1), draw.uniform(0, 4));
    const Motion b = at(draw.in_ball(10), 8 * draw.direction(), draw.uniform(0, 1), draw.uniform(0, 4));
    const double found = earliest_contact(a, b, 2, 1e-12);
    const auto gap = [&](double t) {
      const Vec3 apart = b.position - a.position + t * (b.velocity - a.velocity);
      return std::sqrt(dot(apart, apart)) - a.radius - b.radius - (a.acceleration + b.acceleration) * t * t / 2;
    };
    double first = kNever;
    for (int i = 0; i <= 2000 && first == kNever; ++i) {
      if (gap(0.001 * i) <= 0) first = 0.001 * i;
    }
    EXPECT_LE(found, first) << trial;
    if (found <= 2) {
      ++meeting;
      EXPECT_NEAR(gap(found), found == 0 ? std::min(0.0, gap(0)) : 0, 1e-6) << trial;
    }
  }
  EXPECT_GT(meeting, 300);
}

// The bound holds for what bodies really do: half-spaces included, accelerations as large as allowed.
TEST(HornContact, IsNeverAfterARealContact) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const test::WorldShape shape{.bodies = 2, .ball = 6, .max_acceleration = 30, .half_spaces = 0.7, .extreme = true};
    const test::MovingBodies bodies(shape, seed);
    const double found = earliest_contact(bodies.motion(0, 0), bodies.motion(1, 0), 1, 1e-9);
    for (double t = 0; t <= 1 && t < found; t += 0.002) {
      ASSERT_FALSE(spheres_touch(bodies.motion(0, t), bodies.motion(1, t))) << "seed " << seed << " time " << t;
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
