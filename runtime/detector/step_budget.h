#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>

#include "orchard/runtime/detector.h"

namespace orchard::runtime::detail {

// What is left of the work and the time of a step, and where it cuts the step short: as the clock says, or as another
// run's clock said. For one thread.
class StepBudget {
 public:
  using Clock = std::chrono::steady_clock;
  StepBudget(const Budget& budget, const StepCut* replay) noexcept
      : left_(budget.work), limited_(budget.work != Budget{}.work), replay_(replay) {
    if (replay == nullptr &&
        budget.time < std::chrono::hours(24 * 365)) {  // more is no limit, and would overflow the clock
      timed_ = true;
      deadline_ = Clock::now() + budget.time;
    }
  }
  bool limited_in_work() const noexcept { return limited_; }
  std::uint64_t left() const noexcept { return left_; }
  void spend(std::uint64_t work) noexcept {
    spent_ += work;
    if (!limited_) return;
    const std::uint64_t within = std::min(work, left_);
    left_ -= within, beyond_ += work - within;
  }
  std::uint64_t spent() const noexcept { return spent_; }
  bool late() const noexcept { return timed_ && Clock::now() >= deadline_; }
  std::chrono::nanoseconds time_left() const noexcept {
    return timed_ ? std::max(std::chrono::nanoseconds(0), std::chrono::nanoseconds(deadline_ - Clock::now()))
                  : Budget{}.time;
  }
  bool timed() const noexcept { return timed_; }
  double clock() const noexcept {  // ns since some time; 0 if there is no limit in time
    return timed_ ? std::chrono::duration<double, std::nano>(Clock::now().time_since_epoch()).count() : 0;
  }
  // Sets a part of what is left aside, until it is given back. Time as well, or only time.
  struct Part {
    std::uint64_t work = 0;
    std::chrono::nanoseconds time{};
  };
  Part part(std::uint64_t among) const noexcept {
    return {limited_ ? left_ / among : 0,
            timed_ ? time_left() / static_cast<std::int64_t>(among) : std::chrono::nanoseconds{}};
  }
  void set_aside(const Part& part) noexcept {
    left_ -= part.work;
    deadline_ -= part.time;
  }
  void give_back(const Part& part) noexcept {
    const std::uint64_t overshoot = std::min(beyond_, part.work);  // comes out of it, or overshoots would add up
    left_ += part.work - overshoot, beyond_ -= overshoot;
    deadline_ += part.time;
  }

  bool limited() const noexcept { return limited_in_work() || timed() || replay_ != nullptr; }
  // One of `among` equal shares of what is left.
  StepBudget share(std::uint64_t among) const noexcept {  // this one first
    Budget part;
    if (limited_) part.work = left_ / among + (left_ % among != 0 ? 1 : 0);
    if (timed_) part.time = time_left() / static_cast<std::int64_t>(among);
    return {part, replay_};
  }

  const StepCut* replay() const noexcept { return replay_; }
  const StepCut& cut() const noexcept { return cut_; }
  bool may_go_on() noexcept { return left() > 0 && reaches(&StepCut::begun, begun_); }  // with beginning
  bool may_begin() noexcept {
    const bool may = reaches(&StepCut::begun, begun_);
    begun_ += may ? 1 : 0;
    return may;
  }
  bool may_refine() noexcept { return left() > 0 && reaches(&StepCut::refined, refined_); }
  bool may_sweep(std::uint64_t pair) noexcept { return left() > 0 && reaches(&StepCut::swept, pair); }
  std::uint64_t piece(std::uint64_t slice) const noexcept {
    return replay_ == nullptr ? slice : std::min(slice, replay_->refined - refined_ - 1);
  }
  void refined(std::uint64_t work) noexcept { refined_ += work + 1; }
  void cut_broad(std::uint64_t work) noexcept { cut_.broad = work; }

 private:
  bool reaches(std::uint64_t StepCut::*stage, std::uint64_t done) noexcept {
    const bool stop = replay_ != nullptr ? done >= replay_->*stage : late();
    if (stop) cut_.*stage = std::min(cut_.*stage, done);
    return !stop;
  }

  std::uint64_t left_, beyond_ = 0, spent_ = 0;  // beyond_: spent when nothing was left
  bool limited_, timed_ = false;
  Clock::time_point deadline_{};
  const StepCut* replay_;
  StepCut cut_;
  std::uint64_t begun_ = 0, refined_ = 0;
};

}  // namespace orchard::runtime::detail
