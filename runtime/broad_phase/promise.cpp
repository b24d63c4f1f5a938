#include "orchard/runtime/motion.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime {
namespace {

constexpr double kOwnRounding = 1e-9;      // of velocities and radii: the application's own arithmetic
constexpr double kTimeRounding = 0x1p-50;  // of times

double above(double value, double bound) noexcept { return value > bound ? value - bound : 0; }

}  // namespace

PromiseExcess promise_excess(const Motion& promise, double promise_time, const Motion& given, double time,
                             double position_slack) noexcept {
  PromiseExcess excess;
  const double seconds = time - promise_time;
  if (!(seconds >= 0) || time > promise.expiry) return excess;
  const double reach = promise.drift * seconds + promise.acceleration * seconds * seconds / 2;
  const Vec3 foreseen = promise.position + seconds * promise.velocity, off = given.position - foreseen;
  // Of all that has been added up: a body on its way through the world's origin is not more exact there.
  const double coordinates =
      length(given.position) + length(promise.position) + seconds * length(promise.velocity) + reach;
  const double slack = kMotionSlack * coordinates + 2 * position_slack;
  const double size = length(promise.half_space);
  const Vec3 side = size > 0 ? (1 / size) * promise.half_space : Vec3{};
  excess.position = above(length(off), reach + slack);
  excess.side = above(dot(off, side), promise.drift * seconds + slack);
  excess.radius =
      above(std::fabs(given.radius - promise.radius), kOwnRounding * std::max(given.radius, promise.radius));
  if (!(time < promise.expiry - kTimeRounding * (std::fabs(time) + std::fabs(promise_time)))) return excess;
  const Vec3 change = given.velocity - promise.velocity;
  const double drifts = promise.drift + given.drift, bound = drifts + promise.acceleration * seconds;
  const double rounding = kOwnRounding * (length(given.velocity) + length(promise.velocity) + bound);
  excess.velocity = above(length(change), bound + rounding);
  excess.turn = above(dot(change, side), drifts + rounding);
  return excess;
}

bool keeps_promise(const Motion& promise, double promise_time, double now, const Vec3& position, const Vec3* velocity,
                   double position_slack) noexcept {
  if (!(now > promise_time)) return true;
  Motion given = promise;
  given.position = position;
  if (velocity != nullptr) given.velocity = *velocity;
  return promise_excess(promise, promise_time, given, now, position_slack).none();
}

}  // namespace orchard::runtime
