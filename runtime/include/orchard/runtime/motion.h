#pragma once
#include <limits>

#include "orchard/runtime/vec3.h"

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

}  // namespace orchard::runtime
