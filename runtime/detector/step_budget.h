#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>

#include "orchard/runtime/detector.h"

namespace orchard::runtime::detail {

// What is left of a step's budget.
class StepBudget {
 public:
  using Clock = std::chrono::steady_clock;
  explicit StepBudget(const FrameBudget& budget) noexcept
      : left_(budget.work), limited_(budget.work != FrameBudget{}.work) {
    if (budget.time < std::chrono::hours(24 * 365)) {  // more is no limit, and would overflow the clock
      timed_ = true;
      deadline_ = Clock::now() + budget.time;
    }
  }
  bool limited() const noexcept { return limited_ || timed_; }
  bool limited_in_work() const noexcept { return limited_; }
  std::uint64_t left() const noexcept { return left_; }
  void spend(std::uint64_t work) noexcept {
    spent_ += work;
    if (limited_) left_ -= std::min(work, left_);
  }
  std::uint64_t spent() const noexcept { return spent_; }
  bool late() const noexcept { return timed_ && Clock::now() >= deadline_; }
  std::chrono::nanoseconds time_left() const noexcept {
    return timed_ ? std::max(std::chrono::nanoseconds(0), std::chrono::nanoseconds(deadline_ - Clock::now()))
                  : FrameBudget{}.time;
  }
  bool empty() const noexcept { return left_ == 0 || late(); }
  // One of `among` equal shares of what is left, this one first.
  FrameBudget share(std::uint64_t among) const noexcept {
    FrameBudget part;
    if (limited_) part.work = left_ / among + (left_ % among != 0 ? 1 : 0);
    if (timed_) part.time = time_left() / static_cast<std::int64_t>(among);
    return part;
  }

 private:
  std::uint64_t left_, spent_ = 0;
  bool limited_, timed_ = false;
  Clock::time_point deadline_{};
};

}  // namespace orchard::runtime::detail
