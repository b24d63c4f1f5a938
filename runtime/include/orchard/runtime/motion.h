#pragma once
#include <limits>

#include "orchard/runtime/pose.h"

// Bounds on the motion of bodies, and what follows from them.
namespace orchard::runtime {

// The state of a body at time t0, and bounds on its motion until an expiry (dissertation 4.1, 4.4). For t0 <= t <=
// expiry, the centre y of its bounding sphere has |y''(t)| <= acceleration, and y''(t) . half_space <= 0 unless
// half_space is zero. Then
//   |y(t) - (position + velocity s)| <= drift s + acceleration s^2 / 2   with s = t - t0            (Lemma 4.1)
//   (y(t) - (position + velocity s)) . d / |d| <= drift s                                          (Lemma 4.2)
// Lengths are in the world's unit and times in seconds. half_space points *away* from the possible accelerations (for a
// rocket: backwards); it may have any length but 0. To allow for the rounding of an integrator, the bounds may be
// exceeded by kMotionSlack times the size of the coordinates.
struct Motion {
  Vec3 position{};  // y(t0).
  Vec3 velocity{};  // y'(t0), to within drift.
  // The rotational radius (4.1.2): the radius of the sphere around y that contains the body in every orientation.
  double radius = 0;
  double acceleration = 0;  // M.
  double drift = 0;         // An upper bound on |y'(t0) - velocity|: 0 if the velocity is known.
  Vec3 half_space{};        // d.
  double expiry = std::numeric_limits<double>::infinity();
};

// The tolerance of positions, relative to the largest coordinate that a pair has while its bounds hold.
inline constexpr double kMotionSlack = 1e-12;

// The largest number in a motion and the largest time step, so that squares and products stay finite.
inline constexpr double kMaxNumber = 1e100;

// Returns whether all numbers are finite and at most kMaxNumber in size (expiry may be any time or infinity, but not
// NaN), and radius, acceleration and drift are not negative. Every function with a Motion parameter requires this,
// except BroadPhase, which refuses other motions.
bool is_valid(const Motion& motion) noexcept;

// Returns the motion of a body of which only the speed is bounded (8.2). The bound is the ball that the body can reach.
Motion speed_bounded(const Vec3& position, double radius, double max_speed, double expiry) noexcept;

// Returns the motion of a body of which only the position is bounded (8.2): its centre stays within `reach` of `center`
// until `expiry` and may jump there, as a door, a lift or a robot on its stand does. The bound is a body at rest whose
// sphere has the radius reach + radius, so that a broad phase reports a pair as long as the regions meet, whether or
// not the bodies do at that time. Lengths must not be negative; the expiry is a time in seconds.
Motion position_bounded(const Vec3& center, double reach, double radius, double expiry) noexcept;

// Returns whether the closed spheres of two motions at the same time overlap, in double ("really overlap").
inline bool spheres_touch(const Motion& a, const Motion& b) noexcept {
  const Vec3 apart = b.position - a.position;
  const double reach = a.radius + b.radius;
  return dot(apart, apart) <= reach * reach;
}

// Returns a time before which the spheres of two bodies cannot touch, in seconds from the time of both motions (0: they
// may touch now), or infinity if they cannot touch until `limit`. `limit` is finite, and neither motion may expire
// before it. `slack` is added to the radii; it is the total error of the positions.
// The result is the contact of two parabolic horns (8.2), each tightened by its half-space. It is exact for the horns
// to `resolution` seconds and never late: at most the true time. Each round replaces the distance by its tangent, which
// lies below it, and solves a quadratic; two or three rounds suffice.
double earliest_contact(const Motion& a, const Motion& b, double limit, double resolution, double slack = 0) noexcept;

// The following functions decide whether a body has kept the bounds of an earlier motion.

// By how much a motion exceeds each bound of an earlier motion of the same body; 0 if that bound holds. s is the time
// between the two in seconds, and d is the earlier half-space with length 1.
struct MotionBoundExcess {
  double position = 0;  // |y - (position + velocity s)| over drift s + M s^2 / 2: Lemma 4.1. A length.
  double side = 0;      // The same along d, over drift s: Lemma 4.2. A length.
  double velocity = 0;  // |velocity - predicted| over both drifts + M s: M itself. Length per second.
  double turn = 0;      // The same along d, over both drifts: d itself. Length per second.
  double radius = 0;    // The change of the radius. A length.

  bool none() const noexcept { return position == 0 && side == 0 && velocity == 0 && turn == 0 && radius == 0; }
};

// Compares the motion `given` at `time` with the bounds of `bound`, which was given at `bound_time`; both must be
// valid. All values are 0 if the bounds expired before `time` or were given later. The velocity at the time of expiry
// is not compared, since it may jump there. The tolerances are kMotionSlack of the coordinates, in addition
// `position_slack` for positions, and 1e-9 of the values for velocities and radii.
MotionBoundExcess motion_bound_excess(const Motion& bound, double bound_time, const Motion& given, double time,
                                      double position_slack = 0) noexcept;

// Returns whether a body at `position` at the time `now`, with `velocity` unless that is null, keeps the bounds given
// at `bound_time`. This compares the position and the velocity as motion_bound_excess() does, with the drift of `bound`
// alone. Returns true once the bounds have expired.
bool keeps_motion_bound(const Motion& bound, double bound_time, double now, const Vec3& position, const Vec3* velocity,
                        double position_slack = 0) noexcept;

}  // namespace orchard::runtime
