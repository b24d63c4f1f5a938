#include "orchard/runtime/motion_monitor.h"

#include <algorithm>
#include <cmath>

#include "broad_phase/vectors.h"

namespace orchard::runtime {
namespace {

// The cosine of the largest angle between the mean acceleration and each acceleration for which a half-space is
// suggested.
constexpr double kMaxAngle = 0.5;
constexpr double kFasterHorizon = 1.25;  // a horizon without a violation grows by this factor

}  // namespace

void MotionMonitor::Part::add(const Vec3& acceleration) noexcept {
  const double size = length(acceleration);
  largest = std::max(largest, size);
  sum = sum + acceleration;
  ++count;
  if (!(size > 0)) return;
  for (std::size_t i = 0; i < 3; ++i) {
    lower[i] = std::min(lower[i], acceleration[i] / size);
    upper[i] = std::max(upper[i], acceleration[i] / size);
  }
}

double MotionMonitor::Part::min_along(const Vec3& way) const noexcept {
  double least = 0;
  for (std::size_t i = 0; i < 3; ++i) least += std::min(lower[i] * way[i], upper[i] * way[i]);
  return least / length(way);
}

MotionMonitor::Track& MotionMonitor::track(BodyIndex body) {
  detail::grow(tracks_, std::size_t{body} + 1);
  return tracks_[body];
}

void MotionMonitor::note_bound(BodyIndex body, double time, const Motion& motion) {
  Track& t = track(body);
  t.bounded = true;
  t.bound_time = time;
  t.motion = motion;
}

bool MotionMonitor::observe(BodyIndex body, double time, const Vec3& position, const Vec3& velocity) {
  return observe(body, time, position, &velocity);
}

bool MotionMonitor::observe(BodyIndex body, double time, const Vec3& position) {
  return observe(body, time, position, nullptr);
}

void MotionMonitor::count_broken(BodyIndex body) {
  Track& t = track(body);
  t.bounded = false;
  t.horizon = std::max(t.horizon / 2, options_.min_horizon);
  t.kept_since = t.time;
  ++t.broken, ++broken_;
}

bool MotionMonitor::observe(BodyIndex body, double time, const Vec3& position, const Vec3* velocity) {
  Track& t = track(body);
  learn(t, time, position, velocity);
  if (t.bounded && time - t.kept_since >= t.horizon) {  // a whole horizon without a violation
    t.horizon = std::min(t.horizon * kFasterHorizon, options_.longest_horizon);
    t.kept_since = time;
  }
  if (!t.bounded || keeps_motion_bound(t.motion, t.bound_time, time, position, velocity, options_.position_slack))
    return true;
  count_broken(body);
  return false;
}

// An acceleration is computed from the difference of two velocities. If velocities are not given, they are computed
// from positions: (x2 - x1) / h is the velocity in the middle of a step.
void MotionMonitor::learn(Track& t, double time, const Vec3& position, const Vec3* velocity) const noexcept {
  const double step = time - t.time;
  if (t.seen > 0 && !(step > 0)) return;
  if (t.seen == 0) {
    t.horizon = std::max(t.horizon, options_.min_horizon);
    t.parts = {};
    t.part = 0;
    t.parts[0].begin = t.kept_since = time;
  }
  const Vec3 moved = t.seen > 0 ? (1 / step) * (position - t.position) : Vec3{};
  const Vec3 now = velocity != nullptr ? *velocity : moved;
  const std::uint32_t needed = velocity != nullptr ? 1 : 2;  // earlier observations
  if (t.seen >= needed) {
    const double between = velocity != nullptr ? step : (step + t.step) / 2;
    const Vec3 acceleration = (1 / between) * (now - t.velocity);
    if (time - t.parts[t.part].begin >= options_.window / kParts) {
      t.part = (t.part + 1) % kParts;
      t.parts[t.part] = Part{};
      t.parts[t.part].begin = time;
    }
    t.parts[t.part].add(acceleration);
  }
  t.velocity = now;
  t.velocity_given = velocity != nullptr;
  t.time = time, t.step = step, t.position = position;
  t.seen = std::min(t.seen + 1, 3u);
}

Motion MotionMonitor::suggest(BodyIndex body, double time, double radius) const {
  Motion motion;
  motion.radius = radius;
  if (body >= tracks_.size() || tracks_[body].seen == 0) {  // nothing is known, so the bound is for this step only
    motion.expiry = time;
    return motion;
  }
  const Track& t = tracks_[body];
  motion.position = t.position;
  motion.velocity = t.velocity;
  double largest = 0;
  Vec3 sum{};
  std::uint32_t count = 0;
  for (const Part& part : t.parts) {
    largest = std::max(largest, part.largest);
    sum = sum + part.sum;
    count += part.count;
  }
  motion.acceleration = std::max(options_.min_acceleration, options_.safety * largest);
  // A velocity that was computed from positions is that of half a step ago.
  if (!t.velocity_given) motion.drift = motion.acceleration * t.step;
  motion.expiry = count == 0 ? time : time + std::clamp(t.horizon, options_.min_horizon, options_.longest_horizon);
  const double size = length(sum);
  if (count < 2 || !(size > 0)) return motion;
  for (const Part& part : t.parts) {
    if (part.count > 0 && !(part.min_along(sum) >= kMaxAngle)) return motion;
  }
  motion.half_space = (-1 / size) * sum;
  return motion;
}

void MotionMonitor::cancelled(BodyIndex body) { track(body).bounded = false; }

void MotionMonitor::begin(BodyIndex body) { track(body) = Track{}; }

void MotionMonitor::forget(BodyIndex body) {
  Track& t = track(body);
  const std::uint64_t counted = t.broken;
  t = Track{};
  t.broken = counted;
}

}  // namespace orchard::runtime
