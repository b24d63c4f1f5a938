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

// Times of steps. Comparing a time with a step's allows for kStepSlack steps, and for rounding, in the safe direction:
// far from zero rounding is the larger one, up to 1e-3 steps at kMaxSteps.
inline constexpr double kStepSlack = 1e-6;
inline constexpr double kTimeRounding = 0x1p-50;  // relative: of a few operations on times

struct Clock {
  double start, time_step;
  double per_second = 1 / time_step;  // steps

  double time(Step step) const noexcept { return start + static_cast<double>(step) * time_step; }
  // In seconds: what the times of two steps up to this one, and their difference, are off by at most.
  double rounding(Step step) const noexcept {
    return kTimeRounding * (std::fabs(start) + static_cast<double>(step) * time_step);
  }
  // From when on a time is taken for the step's.
  double earliest(Step step) const noexcept { return time(step) - (kStepSlack * time_step + rounding(step)); }
  // The last step that is not after a time, below 0 before the first one. With room for rounding here: of what is taken
  // for a step's time that step is the last one.
  Step step_at(double time) const noexcept {
    const double passed = time - start, slack = 2 * kTimeRounding * (std::fabs(start) + std::fabs(passed));
    return static_cast<Step>(std::floor((passed + slack) / time_step + kStepSlack));
  }
  // At least as long as what lies between the times of two steps.
  double seconds_between(Step from, Step to) const noexcept {
    return from == to ? 0 : static_cast<double>(to - from) * time_step + rounding(to);
  }
  // The number of steps after `now` whose time lies before `seconds` after it; at least 0.
  Step steps_before(double seconds, Step now) const noexcept {
    const double steps = std::ceil((seconds * (1 - kTimeRounding) - rounding(now)) * per_second - kStepSlack);
    return steps < 1e15 ? static_cast<Step>(std::max(0.0, steps)) : kNeverStep;
  }
  // The number of steps after `now` that are surely not later than `seconds` after it.
  Step steps_within(double seconds, Step now) const noexcept {
    return static_cast<Step>(std::max(0.0, (seconds * (1 - kTimeRounding) - rounding(now)) * per_second - kStepSlack));
  }
  // The last step at which a bound that expires at `expiry` holds. An application that means a step's time gets this
  // step, although it may have computed the time in another way.
  Step last_before_expiry(double expiry) const noexcept {
    const double steps = (expiry - start) / time_step;
    const double rounding = kTimeRounding * ((std::fabs(expiry) + std::fabs(start)) / time_step + std::fabs(steps));
    return steps < 1e15 ? static_cast<Step>(std::floor(std::max(-1.0, steps + std::min(rounding, kStepSlack))))
                        : kNeverStep;
  }
};

// Counts work against a budget. Without one it never stops.
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
  // Units that may still be done; at least 1.
  std::uint64_t left() const noexcept { return budget_.work > done_ ? budget_.work - done_ : 1; }
  // How many of `wanted` units may be done before asking again.
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
