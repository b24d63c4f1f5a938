#include "orchard/runtime/motion_helpers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace orchard::runtime {
namespace {

constexpr double kQuarterTurn = std::numbers::pi / 2;
constexpr double kWorthwhile = 0.5;  // of the horizon: a half-space that ends earlier costs more updates than it saves

Motion bounded(const Vec3& position, const Vec3& velocity, double radius, double acceleration, double expiry) noexcept {
  return {.position = position, .velocity = velocity, .radius = radius, .acceleration = acceleration, .expiry = expiry};
}

// Adds a half-space to a motion whose acceleration stays on the side of `direction` for `lasting` seconds, if this is
// long enough to be worthwhile.
void keep_to_side(Motion& motion, const Vec3& direction, double lasting, double time, double horizon) noexcept {
  if (!(lasting >= kWorthwhile * horizon)) return;
  motion.half_space = -1.0 * direction;
  motion.expiry = time + std::min(lasting, horizon);
}

double quarter_turn_time(double angular_speed) noexcept {
  return angular_speed > 0 ? kQuarterTurn / angular_speed : std::numeric_limits<double>::infinity();
}

}  // namespace

Motion rocket_motion(const Rocket& r, double time, double horizon) noexcept {
  Motion motion = bounded(r.position, r.velocity, r.radius, r.max_thrust, time + horizon);
  keep_to_side(motion, r.axis, quarter_turn_time(r.max_turning), time, horizon);
  return motion;
}

Motion vehicle_motion(const Vehicle& v, double time, double horizon) noexcept {
  constexpr Vec3 not_given{};
  const double centripetal = v.max_speed * v.max_speed / v.min_turn_radius;
  Motion motion = bounded(v.position, v.velocity, v.radius, std::hypot(centripetal, v.max_drive), time + horizon);
  if (v.max_drive == 0 && v.to_center != not_given) {
    keep_to_side(motion, v.to_center, quarter_turn_time(v.max_speed / v.min_turn_radius), time, horizon);
  }
  return motion;
}

Motion dragged_motion(const Dragged& d, double time, double horizon) noexcept {
  // The second difference is a mean of the acceleration over the last two steps, which lie `step` back on average.
  const double h = d.step;
  const Vec3 mean = (1 / (h * h)) * (d.position - 2.0 * d.last + d.before_last);
  const double change = d.max_jerk * (h + horizon), size = length(mean);
  const Vec3 velocity = (1 / h) * (d.position - d.last) + (h / 2) * mean;
  Motion motion = bounded(d.position, velocity, d.radius, size + change, time + horizon);
  motion.drift = d.max_jerk * h * h / 2;
  if (size > change) keep_to_side(motion, mean, horizon, time, horizon);
  return motion;
}

Motion spring_motion(const SpringDragged& d, double time, double horizon) noexcept {
  // e = sqrt(|y'|^2 + k |y - cursor|^2) grows by at most k * cursor_reach per second, because damping only reduces it.
  const Vec3 pull = d.cursor - d.position;
  const double stretch = length(pull), feed = d.stiffness * d.cursor_reach;
  const double e = std::sqrt(dot(d.velocity, d.velocity) + d.stiffness * stretch * stretch) + feed * horizon;
  const double acceleration = e * std::sqrt(d.stiffness + d.damping * d.damping) + feed;
  Motion motion = bounded(d.position, d.velocity, d.radius, acceleration, time + horizon);
  // The object is no faster than e. So it stays so far behind the cursor that the spring outweighs the damper, for at
  // least `reserve` / e seconds.
  const double reserve = stretch - d.cursor_reach - d.damping * e / d.stiffness;
  if (stretch > 0 && e > 0) keep_to_side(motion, pull, reserve / e, time, horizon);
  return motion;
}

namespace {

constexpr double kFloatUnit = 0x1p-24;    // half of a float's last place, relative
constexpr double kMinFloat = 0x1p-150;    // the same for the smallest floats, absolute
constexpr double kRoundings = 9;          // the roundings of a change: eight, and their products
const double kDiagonal = std::sqrt(3.0);  // of a cube of edge 1
constexpr double kOutward = 1 + 0x1p-50;  // covers the roundings here

// c of the proof in the header, by Integrator: how much of M dt^2 a step may add to a position beyond dt v.
constexpr std::array<double, 10> kOwnShare = {0, 1, 1, 0.5, 0.5, 1, 1, 0.5, 0.5, 0.5};

}  // namespace

double drift_of(Integrator integrator, double dt, double max_acceleration, Sampling sampling) noexcept {
  static_assert(kOwnShare.size() == static_cast<std::size_t>(Integrator::runge_kutta_4) + 1);
  const double c = kOwnShare[static_cast<std::size_t>(integrator)],
               share = sampling == Sampling::between ? c + 1 : std::max(0.0, c - 0.5);
  return share * max_acceleration * dt * kOutward;
}

double float_slack(double max_coordinate) noexcept {
  return kDiagonal * (kFloatUnit * max_coordinate + kMinFloat) * kOutward;
}

Motion kept_in_float(const Motion& motion, double dt, double max_coordinate, double max_speed) noexcept {
  const double position = kFloatUnit * (max_coordinate + kRoundings * dt * max_speed) + kMinFloat;
  const double velocity = kFloatUnit * (max_speed + kRoundings * dt * motion.acceleration) + kMinFloat;
  Motion result = motion;
  result.drift += kDiagonal * position / dt * kOutward;
  result.acceleration += kDiagonal * velocity / dt * kOutward;
  result.half_space = {};
  return result;
}

}  // namespace orchard::runtime
