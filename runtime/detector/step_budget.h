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
      : left_(budget.work), limited_(budget.work != FrameBudget{}.work), replay_(budget.replay) {
    if (replay_ != nullptr) return;
    if (budget.time < std::chrono::hours(24 * 365)) {  // more is no limit, and would overflow the clock
      timed_ = true;
      deadline_ = Clock::now() + budget.time;
    }
  }
  bool limited() const noexcept { return limited_ || timed_ || replay_ != nullptr; }
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
  // One of `among` equal shares of what is left, this one first.
  FrameBudget share(std::uint64_t among) const noexcept {
    FrameBudget part;
    if (limited_) part.work = left_ / among + (left_ % among != 0 ? 1 : 0);
    if (timed_) part.time = time_left() / static_cast<std::int64_t>(among);
    part.replay = replay_;
    return part;
  }

  // Where the step is cut short: as the clock says, or as another run's clock said. For one thread.
  const StepCut* replay() const noexcept { return replay_; }
  const StepCut& cut() const noexcept { return cut_; }
  bool may_begin(std::uint64_t pair) noexcept { return may_go_on(&StepCut::begun, pair); }
  bool may_refine() noexcept { return left_ > 0 && may_go_on(&StepCut::refined, refined_); }
  bool may_sweep(std::uint64_t pair) noexcept { return left_ > 0 && may_go_on(&StepCut::swept, pair); }
  std::uint64_t piece(std::uint64_t slice) const noexcept {
    return replay_ == nullptr ? slice : std::min(slice, replay_->refined - refined_ - 1);
  }
  void refined(std::uint64_t work) noexcept { refined_ += work + 1; }
  void cut_broad(std::uint64_t work) noexcept { cut_.broad = work; }

 private:
  bool may_go_on(std::uint64_t StepCut::*stage, std::uint64_t done) noexcept {
    const bool stop = replay_ != nullptr ? done >= replay_->*stage : late();
    if (stop) cut_.*stage = std::min(cut_.*stage, done);
    return !stop;
  }

  std::uint64_t left_, spent_ = 0;
  bool limited_, timed_ = false;
  Clock::time_point deadline_{};
  const StepCut* replay_;
  StepCut cut_;
  std::uint64_t refined_ = 0;
};

}  // namespace orchard::runtime::detail
