#pragma once
#include <cstdint>

#include "orchard/runtime/motion.h"

// Computes motion bounds for common kinds of bodies and for integrators.
//
// The functions for bodies compute M and d (dissertation 4.4, with the directions of d negated, because those in the
// text contradict its own condition). Each returns a Motion as of `time`. It expires after `horizon` seconds, or when
// its half-space ceases to hold, if that is earlier. A half-space that holds for less than half of `horizon` is left
// out. If the user does something that the bounds exclude, the application calls BroadPhase::cancel() and gives other
// bounds. Units are lengths, seconds and radians.
namespace orchard::runtime {

// A spaceship whose engine pushes along its axis, and whose rudder turns the axis.
struct Rocket {
  Vec3 position{}, velocity{};
  double radius = 0;
  Vec3 axis{1, 0, 0};  // Forward, of length 1.
  // An upper bound on the engine's acceleration: the present value and a margin for the throttle.
  double max_thrust = 0;
  // An upper bound on the angular speed of the axis: the present value and a margin for the rudder.
  double max_turning = 0;
};
// Returns a motion with the thrust as M. The half-space holds until the axis may have turned by 90 degrees.
Motion rocket_motion(const Rocket& rocket, double time, double horizon) noexcept;

// A car or an aircraft in a turn. Its centripetal acceleration v^2 / R points to the centre, always on the same side
// and in one plane, and it accelerates or brakes along its heading.
struct Vehicle {
  Vec3 position{}, velocity{};
  double radius = 0;
  Vec3 to_center{};            // From the vehicle to the centre of the turn, of length 1; zero: either side.
  double max_speed = 0;        // Until the horizon.
  double min_turn_radius = 1;  // A lower bound on R.
  double max_drive = 0;        // An upper bound on the acceleration along the heading.
};
// Returns a motion with both accelerations together as M. There is a half-space only at constant speed (max_drive 0),
// until the heading may have turned by 90 degrees.
Motion vehicle_motion(const Vehicle& vehicle, double time, double horizon) noexcept;

// An object that follows the user's cursor exactly. Known are its last three positions, `step` seconds apart, the last
// one at `time`, and max_jerk, the largest change of its acceleration per second.
struct Dragged {
  Vec3 before_last{}, last{}, position{};
  double step = 0.01;
  double radius = 0;
  double max_jerk = 0;
};
// Returns a motion with the velocity and the acceleration from finite differences. M and the drift include the largest
// errors of these that max_jerk allows.
Motion dragged_motion(const Dragged& dragged, double time, double horizon) noexcept;

// An object on a damped spring to the cursor: y'' = stiffness (cursor - y) - damping y'. The cursor stays within
// cursor_reach of its present place until the horizon.
struct SpringDragged {
  Vec3 position{}, velocity{};
  double radius = 0;
  Vec3 cursor{};
  double stiffness = 1, damping = 0;  // In 1/s^2 and 1/s.
  double cursor_reach = 0;
};
// Returns a motion with M from the energy, which the cursor can increase only at a bounded rate. The half-space holds
// while the spring is certain to pull.
Motion spring_motion(const SpringDragged& dragged, double time, double horizon) noexcept;

// The method of a simulation in steps of dt, with |acceleration| <= M at every evaluation. The bounds describe motion
// in continuous time; the result of an integrator may differ from it by a drift, which drift_of() returns. Add it to
// Motion::drift.
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

// Which positions the broad phase receives.
enum class Sampling : std::uint8_t {
  at_steps,  // Those at the integrator's steps.
  between    // Linear interpolations between the last step and the next, as for drawing.
};

// Returns the smallest drift with which Lemmas 4.1 and 4.2 hold for everything that the integrator can do, if the
// motion has the velocity of the last step; it is 0 for most integrators. Proof: in each of these methods a step
// changes the position by h v + p and the velocity by q, where h = dt, p and q are sums of evaluated accelerations with
// non-negative weights, |p| <= c M h^2 and |q| <= M h. After n steps, s = n h, the position is off x + s v by sum(p) +
// h sum over k < n of (v_k - v), at most
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

// Returns how far a position moves if its coordinates, at most `max_coordinate` in size, are rounded to float. Use it
// as BroadPhaseOptions::position_slack if the simulation computes in double but gives its positions in float. A
// velocity rounded to float is off by float_slack() of its largest coordinate, which is a drift.
double float_slack(double max_coordinate) noexcept;

// Returns the motion of a simulation that also *keeps* positions and velocities as floats. Each step rounds again,
// which acts as drift and acceleration. The result has both enlarged, and no half-space, because roundings point in any
// direction. The bounds on the coordinates of position and velocity must hold until the motion expires.
// In each step, a coordinate of the position is rounded once and its change dt v up to eight times, so it is off by u
// (L + 9 dt S) with u = 2^-24, the largest coordinate L and the largest speed S along an axis. A coordinate of the
// velocity is off by u (S + 9 dt M). n steps with an error e each are a drift of e / dt, and n changes of the velocity
// are an acceleration of e / dt.
Motion kept_in_float(const Motion& motion, double dt, double max_coordinate, double max_speed) noexcept;

}  // namespace orchard::runtime
