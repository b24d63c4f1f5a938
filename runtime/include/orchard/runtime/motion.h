#pragma once
#include <limits>

#include "orchard/runtime/pose.h"

namespace orchard::runtime {

// What is known of a body at time t0 and for a while after (dissertation 4.1, 4.4): for t0 <= t <= expiry the centre y
// of its bounding sphere has |y''(t)| <= acceleration, and y''(t) . half_space <= 0 unless half_space is zero. Then
//   |y(t) - (position + velocity s)| <= drift s + acceleration s^2 / 2   with s = t - t0            (Lemma 4.1)
//   (y(t) - (position + velocity s)) . d / |d| <= drift s                                          (Lemma 4.2)
// Lengths in the world's unit, times in seconds. half_space points *away* from where the acceleration may go (for a
// rocket: backwards); any length but 0 will do.
// The bounds may be exceeded by kMotionSlack times the size of the coordinates: an integrator's rounding.
struct Motion {
  Vec3 position{};    // y(t0)
  Vec3 velocity{};    // y'(t0), to within drift
  double radius = 0;  // the rotational radius (4.1.2): of the sphere around y that holds the body however it turns
  double acceleration = 0;  // M
  double drift = 0;         // bound on |y'(t0) - velocity|: 0 where the velocity is known
  Vec3 half_space{};        // d
  double expiry = std::numeric_limits<double>::infinity();
};

// Of positions, relative to the largest coordinate that a pair has while its bounds hold.
inline constexpr double kMotionSlack = 1e-12;

// No number of a motion, and no time step, is larger: squares and products stay finite.
inline constexpr double kMaxNumber = 1e100;

// All numbers finite and at most kMaxNumber in size (expiry: any time, infinity too, but not NaN); radius,
// acceleration and drift not negative. Every function that takes a Motion requires it, but for BroadPhase, which
// refuses the others.
bool is_valid(const Motion& motion) noexcept;

// 8.2: only the speed is bounded. The bound is the ball that the body can reach.
Motion speed_bounded(const Vec3& position, double radius, double max_speed, double expiry) noexcept;

// 8.2: only the position is bounded. The body's centre stays within `reach` of `center` until `expiry`, and jumps there
// as it likes: a door, a lift, a robot on its stand. The bound is a body at rest whose sphere has the radius reach +
// radius, so a broad phase reports a pair as long as the regions meet, whether or not the bodies do now. Lengths are
// not negative; the expiry is a time, in seconds.
Motion position_bounded(const Vec3& center, double reach, double radius, double expiry) noexcept;

// "Really overlap": closed, in double, from two positions at the same time.
inline bool spheres_touch(const Motion& a, const Motion& b) noexcept {
  const Vec3 apart = b.position - a.position;
  const double reach = a.radius + b.radius;
  return dot(apart, apart) <= reach * reach;
}

// A time before which the two bodies' spheres cannot touch, in seconds from the time of both motions (0: they may touch
// now), or infinity if they cannot until `limit`, which is finite and by which neither motion has expired.
// Direct contact of two parabolic horns (8.2), each tightened by its half-space. Exact for the horns to `resolution`
// seconds, and never late: the result is at most the true time.
// Each round replaces the distance by its tangent, which lies below it, and solves a quadratic: two or three suffice.
// `slack` is added to the radii: what the positions may be wrong by, all together.
double earliest_contact(const Motion& a, const Motion& b, double limit, double resolution, double slack = 0) noexcept;

// A Motion is a promise. These tell whether it was kept.

// By how much a motion exceeds each bound of one that was promised before; 0: that bound holds. With s the seconds from
// one to the other and d the promised half-space, of length 1:
struct MotionBoundExcess {
  double position = 0;  // |y - (position + velocity s)| over drift s + M s^2 / 2: Lemma 4.1. A length
  double side = 0;      // of the same along d, over drift s: Lemma 4.2. A length
  double velocity = 0;  // |velocity - promised| over both drifts + M s: M itself. Lengths per second
  double turn = 0;      // of the same along d, over both drifts: d itself. Lengths per second
  double radius = 0;    // how much it has changed. A length

  bool none() const noexcept { return position == 0 && side == 0 && velocity == 0 && turn == 0 && radius == 0; }
};

// Of `given` at `time` over `promise` at `bound_time`; both are valid. None where the promise expired before, or was
// made after. What a velocity is at the time of expiry is left open, as it may jump there. Each is allowed kMotionSlack
// of the coordinates, positions `position_slack` besides, velocities and radii 1e-9 of themselves.
MotionBoundExcess motion_bound_excess(const Motion& bound, double bound_time, const Motion& given, double time,
                                      double position_slack = 0) noexcept;

// Whether a body that is at `position` now, with `velocity` unless that is null, has kept what was promised at
// `bound_time`: the same of the position and the velocity, whose drift is that of the promise. True once the promise
// has expired.
bool keeps_motion_bound(const Motion& bound, double bound_time, double now, const Vec3& position, const Vec3* velocity,
                        double position_slack = 0) noexcept;

}  // namespace orchard::runtime
