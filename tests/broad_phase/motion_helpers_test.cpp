#include "orchard/runtime/motion_helpers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "worlds.h"

namespace orchard::runtime {
namespace {

constexpr double kDt = 1e-4;  // the simulations' step: their own error is of its order
constexpr Vec3 kNoHalfSpace{};

// Follows a simulated body and checks what was announced: acceleration, half-space, and where both lead.
class Watch {
 public:
  Watch(const Motion& motion, double time) : motion_(motion), begin_(time) {}

  void see(double time, const Vec3& position, const Vec3& acceleration) {
    if (time > motion_.expiry) return;
    const double t = time - begin_, allowed = 1e-3 * (1 + length(acceleration));
    EXPECT_LE(length(acceleration), motion_.acceleration + allowed) << "after " << t;
    const double d = length(motion_.half_space);
    EXPECT_LE(d > 0 ? dot(acceleration, motion_.half_space) / d : 0, allowed) << "after " << t;
    const Vec3 off = position - motion_.position - t * motion_.velocity;
    EXPECT_LE(length(off), motion_.drift * t + motion_.acceleration * t * t / 2 + allowed * (t + kDt)) << "after " << t;
    last_ = time;
  }
  double seen() const { return last_ - begin_; }

 private:
  Motion motion_;
  double begin_, last_ = 0;
};

Vec3 across(const Vec3& v, test::Draw& draw) {  // a unit vector at right angles to v
  const Vec3 u = draw.direction();
  const Vec3 w = u - (dot(u, v) / dot(v, v)) * v;
  return (1 / length(w)) * w;
}

Vec3 turned(const Vec3& v, const Vec3& towards, double angle) {
  return std::cos(angle) * v + std::sin(angle) * towards;
}

TEST(RocketMotion, HoldsForAnyThrottleAndRudderWithinTheBounds) {
  int with_half_space = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    test::Draw draw(seed);
    Rocket rocket{draw.in_ball(10), 5 * draw.direction(), 1, draw.direction(), draw.uniform(0, 8), draw.uniform(0, 5)};
    const Motion motion = rocket_motion(rocket, 3, 1);
    with_half_space += motion.half_space != kNoHalfSpace;
    EXPECT_GT(motion.expiry, 3.49);
    EXPECT_LE(motion.expiry, 4);
    Watch watch(motion, 3);
    Vec3 position = rocket.position, velocity = rocket.velocity, axis = rocket.axis, side = across(axis, draw);
    for (int i = 0; kDt * i < 1; ++i) {
      const double t = kDt * i;
      if (draw.uniform(0, 1) < 0.001 && seed % 2 == 0) side = across(axis, draw);  // another way
      const Vec3 a = (seed % 3 == 0 ? 1 : draw.uniform(0, 1)) * rocket.max_thrust * axis;
      watch.see(3 + t, position, a);
      position = position + kDt * velocity;
      velocity = velocity + kDt * a;
      const Vec3 next = turned(axis, side, rocket.max_turning * kDt);
      side = turned(side, -1.0 * axis, rocket.max_turning * kDt);
      axis = next;
    }
    EXPECT_GT(watch.seen(), 0.49);
  }
  EXPECT_GT(with_half_space, 20);
  EXPECT_LT(with_half_space, 100);
}

TEST(VehicleMotion, HoldsInATurnNoTighterThanAnnounced) {
  int with_half_space = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    test::Draw draw(seed);
    Vec3 heading = draw.direction(), side = across(heading, draw);
    Vehicle vehicle{draw.in_ball(10), 8.0 * heading, 1, side, 8, draw.uniform(2, 20), 0};
    if (seed % 4 == 0) vehicle.to_center = {};
    if (seed % 4 == 1) vehicle.max_drive = 3, vehicle.max_speed = 8 + 3;
    const Motion motion = vehicle_motion(vehicle, 0, 1);
    with_half_space += motion.half_space != kNoHalfSpace;
    Watch watch(motion, 0);
    Vec3 position = vehicle.position;
    double speed = 8, sharpness = 1;
    for (int i = 0; kDt * i < 1; ++i) {
      const double t = kDt * i;
      if (draw.uniform(0, 1) < 0.002) sharpness = draw.uniform(0, 1);  // the same side, as tight as allowed at most
      const double drive = seed % 4 == 1 ? (seed % 8 == 1 ? 3 : -3) : 0;
      const double turning = sharpness * speed / vehicle.min_turn_radius;
      watch.see(t, position, speed * turning * side + drive * heading);
      position = position + kDt * speed * heading;
      speed += kDt * drive;
      const Vec3 next = turned(heading, side, turning * kDt);
      side = turned(side, -1.0 * heading, turning * kDt);
      heading = next;
    }
    EXPECT_GT(watch.seen(), 0.49);
  }
  EXPECT_GT(with_half_space, 20);
}

TEST(DraggedMotion, HoldsForTheJerkAnnounced) {
  int with_half_space = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    test::Draw draw(seed);
    // A hand: sums of slow oscillations, whose jerk is known.
    struct Swing {
      Vec3 size;
      double speed, phase;
    };
    std::vector<Swing> swings;
    double jerk = 0;
    for (int i = 0; i < 3; ++i) {
      swings.push_back({draw.uniform(0, 3) * draw.direction(), draw.uniform(0.3, 3), draw.uniform(0, 6)});
      jerk += length(swings.back().size) * std::pow(swings.back().speed, 3);
    }
    const auto moved = [&](double t, int order) {  // the derivative of that order
      Vec3 sum{};
      for (const Swing& s : swings) {
        sum = sum + std::pow(s.speed, order) * std::sin(s.speed * t + s.phase + order * 1.5707963267948966) * s.size;
      }
      return sum;
    };
    const double step = draw.uniform(0.01, 0.05), now = 2;
    const Dragged dragged{moved(now - 2 * step, 0), moved(now - step, 0), moved(now, 0), step, 1, jerk};
    const Motion motion = dragged_motion(dragged, now, 0.3);
    with_half_space += motion.half_space != kNoHalfSpace;
    EXPECT_LE(length(motion.velocity - moved(now, 1)), motion.drift + 1e-9) << seed;
    Watch watch(motion, now);
    for (int i = 0; i < 300; ++i) {
      const double t = now + 0.001 * i;
      watch.see(t, moved(t, 0), moved(t, 2));
    }
  }
  EXPECT_GT(with_half_space, 20);
}

TEST(SpringMotion, HoldsWhereverTheCursorGoesWithinItsReach) {
  int with_half_space = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    test::Draw draw(seed);
    const SpringDragged dragged{draw.in_ball(10),
                                draw.uniform(0, 5) * draw.direction(),
                                1,
                                draw.in_ball(10),
                                draw.uniform(0.2, 20),
                                draw.uniform(0, 3),
                                draw.uniform(0, 1)};
    const Motion motion = spring_motion(dragged, 0, 0.2);
    with_half_space += motion.half_space != kNoHalfSpace;
    Watch watch(motion, 0);
    Vec3 position = dragged.position, velocity = dragged.velocity, cursor = dragged.cursor;
    for (int i = 0; kDt * i < 0.2; ++i) {
      const double t = kDt * i;
      if (draw.uniform(0, 1) < 0.005) cursor = dragged.cursor + dragged.cursor_reach * draw.direction();
      const Vec3 a = dragged.stiffness * (cursor - position) - dragged.damping * velocity;
      watch.see(t, position, a);
      velocity = velocity + kDt * a;
      position = position + kDt * velocity;
    }
  }
  EXPECT_GT(with_half_space, 10);
}

}  // namespace
}  // namespace orchard::runtime
