#pragma once
#include <cstdint>

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
  Vec3 axis{1, 0, 0};      // forward, of length 1
  double max_thrust = 0;   // bound on the engine's acceleration: the present one, and some slack for the throttle
  double max_turning = 0;  // bound on the axis' angular speed: the present one, and some slack for the rudder
};
// M is the thrust; the half-space holds until the axis may have turned by 90 degrees.
Motion rocket_motion(const Rocket& rocket, double time, double horizon) noexcept;

// A car or an aircraft in a turn: centripetal acceleration v^2 / R towards the centre, on the same side all the time,
// in one plane, and acceleration or braking along its heading.
struct Vehicle {
  Vec3 position{}, velocity{};
  double radius = 0;
  Vec3 to_center{};            // from the vehicle to the turn's centre, of length 1; zero: either side
  double max_speed = 0;        // until the horizon
  double min_turn_radius = 1;  // R: an underestimate
  double max_drive = 0;        // bound on the acceleration along the heading
};
// M is that of both accelerations together; a half-space exists only at constant speed (max_drive 0), until the
// heading may have turned by 90 degrees.
Motion vehicle_motion(const Vehicle& vehicle, double time, double horizon) noexcept;

// An object under the user's cursor, known by its last three positions, `step` apart, the last one at `time`. Provided
// that the acceleration changes by at most max_jerk per second from the first one on, everything else follows from
// finite differences: acceleration, velocity and how wrong they can be.
struct Dragged {
  Vec3 before_last{}, last{}, position{};
  double step = 0.01;
  double radius = 0;
  double max_jerk = 0;
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

// A simulation in steps of dt, with |acceleration| <= M at every evaluation. Bounds are about motion in continuous
// time; what an integrator makes of it may stray from it, by a drift that drift_of() gives: add it to Motion::drift.
enum class Integrator : std::uint8_t {
  explicit_euler,       // x += dt v; v += dt a
  semi_implicit_euler,  // v += dt a; x += dt v. Also called symplectic; what most games and rigid-body engines do
  implicit_euler,       // the same, with the acceleration of the step's end
  velocity_verlet,      // x += dt v + dt^2 a / 2; v += dt (a + a') / 2. Also leapfrog as kick-drift-kick
  position_verlet,      // x += dt v / 2; v += dt a; x += dt v / 2. Also leapfrog as drift-kick-drift
  staggered_leapfrog,   // v half a step off: v(t + dt/2) = v(t - dt/2) + dt a; x += dt v(t + dt/2). Either one is given
  stoermer,             // x(t + dt) = 2 x(t) - x(t - dt) + dt^2 a; the velocity given is (x(t) - x(t - dt)) / dt
  midpoint,             // second-order Runge-Kutta, and the implicit midpoint rule
  heun,                 // second-order Runge-Kutta, and the implicit trapezoidal rule
  runge_kutta_4         // the classical one
};

// When positions are asked for.
enum class Sampling : std::uint8_t {
  at_steps,  // as the integrator has them
  between    // interpolated linearly between the last step and the next, as for drawing
};

// The smallest drift with which Lemmas 4.1 and 4.2 hold for everything the integrator can do with the velocity it has
// at the last step; 0 for most. Why: in each of these methods a step changes the position by h v + p and the velocity
// by q, where h = dt, p and q are sums of evaluated accelerations with non-negative weights, |p| <= c M h^2 and |q| <=
// M h. After n steps, s = n h, the position is off x + s v by sum(p) + h sum over k < n of (v_k - v), at most
//   n c M h^2 + h (0 + 1 + .. + (n - 1)) M h  =  M s^2 / 2 + (c - 1/2) M h s,
// and not at all to the side of d if no acceleration points there. So the drift is max(0, c - 1/2) M h. c is
//   0    explicit Euler; staggered leapfrog, given the later velocity
//   1/2  velocity and position Verlet, midpoint, Heun; Runge-Kutta 4, where p = h^2 (a1 + a2 + a3) / 6
//   1    semi-implicit and implicit Euler; staggered leapfrog, given the earlier velocity; Stoermer
// and n accelerations of size M in one direction reach the bound with c = 1. Between steps the path is a polygon whose
// sides' slopes differ from v by at most c M h + M times the time from the beginning of the step in which v was given
// to the beginning of the side, which is at most s + h: integrated, M s^2 / 2 + (c + 1) M h s. For a velocity that is
// the one at the end of the step under way this holds, too. Jumps of the velocity (impacts, impulses of a contact
// solver) are not covered: cancel() after them.
double drift_of(Integrator integrator, double dt, double max_acceleration,
                Sampling sampling = Sampling::at_steps) noexcept;

// How far a position moves when its coordinates, at most `max_coordinate` in size, are rounded to float: for
// BroadPhaseOptions::position_slack, if the simulation runs in double but gives its positions in float. A velocity
// rounded to float is off by float_slack() of its largest coordinate: that is drift.
double float_slack(double max_coordinate) noexcept;

// For a simulation that also *keeps* positions and velocities as floats: each step rounds again, which is drift and
// acceleration. Gives the motion with both enlarged and without its half-space, as roundings point anywhere. The bounds
// on the coordinates of position and velocity hold until the motion expires. Per step a position's coordinate is
// rounded once, and its change dt v up to eight times, so it is off by u (L + 9 dt S) with u = 2^-24, the largest
// coordinate L and the largest speed S along an axis; a velocity's is off by u (S + 9 dt M). n steps of e each are a
// drift of e / dt, and n changes of the velocity an acceleration of e / dt.
Motion kept_in_float(const Motion& motion, double dt, double max_coordinate, double max_speed) noexcept;

}  // namespace orchard::runtime
