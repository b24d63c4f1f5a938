#include "orchard/runtime/motion.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime {
namespace {

constexpr double kOwnRounding = 1e-9;      // relative to velocities and radii, for the application's own arithmetic
constexpr double kTimeRounding = 0x1p-50;  // relative to times

double above(double value, double bound) noexcept { return value > bound ? value - bound : 0; }

}  // namespace

bool is_valid(const Motion& m) noexcept {
  // This test has no branches and mostly suffices. NaN stays in a sum and fails the comparison.
  const double squares = dot(m.position, m.position) + dot(m.velocity, m.velocity) + dot(m.half_space, m.half_space) +
                         (m.radius * m.radius + m.acceleration * m.acceleration + m.drift * m.drift);
  const bool in_range = squares <= kMaxNumber * kMaxNumber, signs = m.radius >= 0 && m.acceleration >= 0;
  if (in_range && signs && m.drift >= 0 && !std::isnan(m.expiry)) return true;
  const auto fits = [](double x) { return std::fabs(x) <= kMaxNumber; };
  for (std::size_t i = 0; i < 3; ++i) {
    if (!fits(m.position[i]) || !fits(m.velocity[i]) || !fits(m.half_space[i])) return false;
  }
  const auto bound = [&](double x) { return fits(x) && x >= 0; };
  return bound(m.radius) && bound(m.acceleration) && bound(m.drift) && !std::isnan(m.expiry);
}

Motion speed_bounded(const Vec3& position, double radius, double max_speed, double expiry) noexcept {
  return {.position = position, .radius = radius, .drift = max_speed, .expiry = expiry};
}

Motion position_bounded(const Vec3& center, double reach, double radius, double expiry) noexcept {
  constexpr double outward = 1 + 0x1p-50;  // for the rounding of the sum
  return {.position = center, .radius = (reach + radius) * outward, .expiry = expiry};
}

MotionBoundExcess motion_bound_excess(const Motion& bound, double bound_time, const Motion& given, double time,
                                      double position_slack) noexcept {
  MotionBoundExcess excess;
  const double seconds = time - bound_time;
  if (!(seconds >= 0) || time > bound.expiry) return excess;
  const double reach = bound.drift * seconds + bound.acceleration * seconds * seconds / 2;
  const Vec3 foreseen = bound.position + seconds * bound.velocity, off = given.position - foreseen;
  // The slack is relative to all numbers that have been added up, because a body that flies through the world's origin
  // is not more exact there.
  const double coordinates = length(given.position) + length(bound.position) + seconds * length(bound.velocity) + reach;
  const double slack = kMotionSlack * coordinates + 2 * position_slack;
  const double size = length(bound.half_space);
  const Vec3 side = size > 0 ? (1 / size) * bound.half_space : Vec3{};
  excess.position = above(length(off), reach + slack);
  excess.side = above(dot(off, side), bound.drift * seconds + slack);
  excess.radius = above(std::fabs(given.radius - bound.radius), kOwnRounding * std::max(given.radius, bound.radius));
  if (!(time < bound.expiry - kTimeRounding * (std::fabs(time) + std::fabs(bound_time)))) return excess;
  const Vec3 change = given.velocity - bound.velocity;
  const double drifts = bound.drift + given.drift, largest = drifts + bound.acceleration * seconds;
  const double rounding = kOwnRounding * (length(given.velocity) + length(bound.velocity) + largest);
  excess.velocity = above(length(change), largest + rounding);
  excess.turn = above(dot(change, side), drifts + rounding);
  return excess;
}

bool keeps_motion_bound(const Motion& bound, double bound_time, double now, const Vec3& position, const Vec3* velocity,
                        double position_slack) noexcept {
  if (!(now > bound_time)) return true;
  Motion given = bound;
  given.position = position;
  if (velocity != nullptr) given.velocity = *velocity;
  return motion_bound_excess(bound, bound_time, given, now, position_slack).none();
}

}  // namespace orchard::runtime
