#pragma once
#include "orchard/runtime/motion.h"

namespace orchard::runtime {

// How an application comes by M and d (dissertation 4.4; its directions of d have to be negated, as done here). Each
// function gives a Motion as of `time` that expires `horizon` seconds later, or earlier where the half-space ends
// earlier, but not before half of that: a shorter half-space is left out. Once the user does what was not foreseen, the
// application calls BroadPhase::cancel() and asks again. Lengths, seconds, radians.

// A spaceship: the engine pushes along the axis, the rudder turns the axis.
struct Rocket {
  Vec3 position{}, velocity{};
  double radius = 0;
  Vec3 axis{1, 0, 0};          // forward, of length 1
  double largest_thrust = 0;   // bound on the engine's acceleration: the present one, and some slack for the throttle
  double largest_turning = 0;  // bound on the axis' angular speed: the present one, and some slack for the rudder
};
// M is the thrust; the half-space holds until the axis may have turned by 90 degrees.
Motion rocket_motion(const Rocket& rocket, double time, double horizon) noexcept;

// A car or an aircraft in a turn: centripetal acceleration v^2 / R towards the centre, on the same side all the time,
// in one plane, and acceleration or braking along its heading.
struct Vehicle {
  Vec3 position{}, velocity{};
  double radius = 0;
  Vec3 to_center{};              // from the vehicle to the turn's centre, of length 1; zero: either side
  double largest_speed = 0;      // until the horizon
  double least_turn_radius = 1;  // R: an underestimate
  double largest_drive = 0;      // bound on the acceleration along the heading
};
// M is that of both accelerations together; a half-space exists only at constant speed (largest_drive 0), until the
// heading may have turned by 90 degrees.
Motion vehicle_motion(const Vehicle& vehicle, double time, double horizon) noexcept;

// An object under the user's cursor, known by its last three positions, `step` apart, the last one at `time`. Provided
// that the acceleration changes by at most largest_jerk per second from the first one on, everything else follows from
// finite differences: acceleration, velocity and how wrong they can be.
struct Dragged {
  Vec3 before_last{}, last{}, position{};
  double step = 0.01;
  double radius = 0;
  double largest_jerk = 0;
};
Motion dragged_motion(const Dragged& dragged, double time, double horizon) noexcept;

// An object on a damped spring to the cursor: y'' = stiffness (cursor - y) - damping y'. The cursor stays within
// cursor_reach of where it is now until the horizon.
struct SpringDragged {
  Vec3 position{}, velocity{};
  double radius = 0;
  Vec3 cursor{};
  double stiffness = 1, damping = 0;  // 1/s^2, 1/s
  double cursor_reach = 0;
};
// M from the energy, which the cursor can only feed at a bounded rate; the half-space while the spring surely pulls.
Motion spring_motion(const SpringDragged& dragged, double time, double horizon) noexcept;

}  // namespace orchard::runtime
