#pragma once
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>

#include "broad_phase/motion_bound_check.h"

namespace orchard::runtime::detail {

using Step = std::int64_t;
inline constexpr Step kNeverStep = std::numeric_limits<Step>::max();

// The times of steps. Comparisons of a time with that of a step allow for kStepSlack steps and for rounding, in the
// safe direction. Far from zero, rounding is larger than kStepSlack: up to 1e-3 steps at kMaxSteps.
inline constexpr double kStepSlack = 1e-6;
inline constexpr double kTimeRounding = 0x1p-50;  // the relative rounding error of a few operations on times

struct Clock {
  double start, time_step;
  double per_second = 1 / time_step;  // the number of steps in a second

  double time(Step step) const noexcept { return start + static_cast<double>(step) * time_step; }
  // Returns a bound, in seconds, on the rounding error of the times of two steps up to this one and of their
  // difference.
  double rounding(Step step) const noexcept {
    return kTimeRounding * (std::fabs(start) + static_cast<double>(step) * time_step);
  }
  // Returns the earliest time that counts as the time of the step.
  double earliest(Step step) const noexcept { return time(step) - (kStepSlack * time_step + rounding(step)); }
  // Returns the last step that is not after a time; it is negative before step 0. It allows for rounding, so that a
  // time that counts as the time of a step gives that step.
  Step step_at(double time) const noexcept {
    const double passed = time - start, slack = 2 * kTimeRounding * (std::fabs(start) + std::fabs(passed));
    return static_cast<Step>(std::floor((passed + slack) / time_step + kStepSlack));
  }
  // Returns an upper bound on the seconds between the times of two steps.
  double seconds_between(Step from, Step to) const noexcept {
    return from == to ? 0 : static_cast<double>(to - from) * time_step + rounding(to);
  }
  // Returns the number of the first step, counted from `now`, that may be `seconds` or more after it; at least 0.
  Step steps_before(double seconds, Step now) const noexcept {
    const double steps = std::ceil((seconds * (1 - kTimeRounding) - rounding(now)) * per_second - kStepSlack);
    return steps < 1e15 ? static_cast<Step>(std::max(0.0, steps)) : kNeverStep;
  }
  // Returns the number of steps after `now` that are certainly not later than `seconds` after it.
  Step steps_within(double seconds, Step now) const noexcept {
    return static_cast<Step>(std::max(0.0, (seconds * (1 - kTimeRounding) - rounding(now)) * per_second - kStepSlack));
  }
  // Returns the last step at which a bound that expires at `expiry` holds. If the application means the time of a step,
  // it is this step, even if the application has computed the time in another way.
  Step last_before_expiry(double expiry) const noexcept {
    const double steps = (expiry - start) / time_step;
    const double rounding = kTimeRounding * ((std::fabs(expiry) + std::fabs(start)) / time_step + std::fabs(steps));
    return steps < 1e15 ? static_cast<Step>(std::floor(std::max(-1.0, steps + std::min(rounding, kStepSlack))))
                        : kNeverStep;
  }
};

// Counts work against a budget, or without a limit.
class BudgetTracker {
 public:
  BudgetTracker() = default;
  explicit BudgetTracker(const Budget& budget, std::uint64_t replay)
      : budget_(budget), replay_(replay), begin_(std::chrono::steady_clock::now()) {}

  bool limited() const noexcept { return budget_.limited() || replay_ != 0; }
  std::uint64_t done() const noexcept { return done_; }
  void count(std::uint64_t work) noexcept {
    done_ += work;
    since_clock_ += work;
  }
  // The first unit is always granted.
  bool spent() noexcept {
    if (done_ == 0) return false;
    if (done_ >= budget_.work) return true;
    if (replay_ != 0) return done_ >= replay_;
    if (since_clock_ < kWorkPerClock || budget_.time == Budget{}.time) return late_;
    since_clock_ = 0;
    late_ = late_ || std::chrono::steady_clock::now() - begin_ >= budget_.time;
    return late_;
  }
  // Returns how many units of work are left; at least 1.
  std::uint64_t left() const noexcept { return budget_.work > done_ ? budget_.work - done_ : 1; }
  // Returns how many of `wanted` units may be done before spent() has to be called again.
  std::size_t grant(std::size_t wanted) const noexcept {
    if (!limited()) return wanted;
    return std::min({wanted, std::size_t{kWorkPerClock}, static_cast<std::size_t>(left())});
  }

 private:
  Budget budget_;
  std::uint64_t replay_ = 0;
  std::chrono::steady_clock::time_point begin_{};
  std::uint64_t done_ = 0, since_clock_ = kWorkPerClock;
  bool late_ = false;
};

}  // namespace orchard::runtime::detail
