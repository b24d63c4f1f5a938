#include "motion_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orchard::broad_phase_methods {
namespace {

// The length, in standard deviations of a coordinate, that a normal vector of three dimensions exceeds with this
// probability.
double exceeded_with(double probability) noexcept {
  double low = 0, high = 40;  // beyond it the probability is 0 in double
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    const double beyond = std::erfc(middle / std::numbers::sqrt2) +
                          std::sqrt(2 / std::numbers::pi) * middle * std::exp(-middle * middle / 2);
    (beyond > probability ? low : high) = middle;
  }
  return high;
}

// Numbers that are not finite are in none of the ranges.
bool is_usable(const MotionFilterOptions& o) noexcept {
  const auto within = [](double value, double least) { return value >= least && value <= runtime::kMaxNumber; };
  return o.noise > 0 && within(o.noise, 0) && o.jerk_density > 0 && within(o.jerk_density, 0) &&
         within(o.max_speed, 0) && within(o.max_acceleration, 0) && o.confidence > 0 && o.confidence < 1;
}

// A variance that rounding has made negative is zero.
double deviation(double variance) noexcept { return std::sqrt(std::max(0.0, variance)); }

}  // namespace

MotionFilter::MotionFilter(const MotionFilterOptions& options) noexcept
    : options_(options), usable_(is_usable(options)) {
  const double doubt = (1 - options.confidence) / 3;
  width_ = exceeded_with(doubt);
  walk_width_ = exceeded_with(doubt / 2);
}

// Constant acceleration, and what white jerk adds to the covariance.
MotionFilter::State MotionFilter::predicted(double s) const noexcept {
  const double q = options_.jerk_density, s2 = s * s, s3 = s2 * s;
  const Covariance& c = state_.covariance;
  State next = state_;
  next.position = state_.position + s * state_.velocity + (s2 / 2) * state_.acceleration;
  next.velocity = state_.velocity + s * state_.acceleration;
  const double xv = c.xv + s * (c.vv + c.xa) + s2 * 1.5 * c.va + s3 / 2 * c.aa;
  next.covariance = {.xx = c.xx + 2 * s * c.xv + s2 * (c.vv + c.xa) + s3 * c.va + s2 * s2 / 4 * c.aa + q * s2 * s3 / 20,
                     .xv = xv + q * s2 * s2 / 8,
                     .xa = c.xa + s * c.va + s2 / 2 * c.aa + q * s3 / 6,
                     .vv = c.vv + 2 * s * c.va + s2 * c.aa + q * s3 / 3,
                     .va = c.va + s * c.aa + q * s2 / 2,
                     .aa = c.aa + q * s};
  return next;
}

bool MotionFilter::add(double time, const Vec3& position) noexcept {
  const double sum = time + position[0] + position[1] + position[2];
  if (!usable_ || !std::isfinite(sum) || (!empty_ && !(time > time_))) return false;
  const double noise = options_.noise * options_.noise;
  if (empty_) {
    const double speed = options_.max_speed, acceleration = options_.max_acceleration;
    state_ = {position, {}, {}, {noise, 0, 0, speed * speed, 0, acceleration * acceleration}};
  } else {
    state_ = predicted(time - time_);
    Covariance& c = state_.covariance;
    const double of_sample = c.xx + noise, kept = noise / of_sample;
    const Vec3 surprise = (1 / of_sample) * (position - state_.position);
    state_.position = state_.position + c.xx * surprise;
    state_.velocity = state_.velocity + c.xv * surprise;
    state_.acceleration = state_.acceleration + c.xa * surprise;
    c = {.xx = c.xx * kept,
         .xv = c.xv * kept,
         .xa = c.xa * kept,
         .vv = c.vv - c.xv * c.xv / of_sample,
         .va = c.va - c.xv * c.xa / of_sample,
         .aa = c.aa - c.xa * c.xa / of_sample};
  }
  time_ = time;
  empty_ = false;
  return true;
}

Motion MotionFilter::motion(double radius, double time, double horizon) const noexcept {
  const State now = predicted(time - time_);
  const Covariance& c = now.covariance;
  const double size = length(now.acceleration);
  const double change = walk_width_ * deviation(c.aa + options_.jerk_density * horizon);
  return {.position = now.position,
          .velocity = now.velocity,
          .radius = radius + width_ * deviation(c.xx),
          .acceleration = size + change,
          .drift = width_ * deviation(c.vv),
          .half_space = size > change ? -now.acceleration : Vec3{},
          .expiry = time + horizon};
}

}  // namespace orchard::broad_phase_methods
