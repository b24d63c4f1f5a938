#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>

#include "orchard/runtime/detector.h"

namespace orchard::runtime::detail {

// The work and the time that are left for a step, and the places at which the step is cut short: by the clock or, in a
// replay, where the clock cut another run. For one thread.
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
  double clock() const noexcept {  // ns since a fixed time; 0 if there is no limit in time
    return timed_ ? std::chrono::duration<double, std::nano>(Clock::now().time_since_epoch()).count() : 0;
  }
  // A part of what is left, which can be set aside until it is given back.
  struct Part {
    std::uint64_t work = 0;
    std::chrono::nanoseconds time{};
  };
  // Returns one of `among` equal parts of what is left.
  Part part(std::uint64_t among) const noexcept {
    return {limited_ ? left_ / among : 0,
            timed_ ? time_left() / static_cast<std::int64_t>(among) : std::chrono::nanoseconds{}};
  }
  void set_aside(const Part& part) noexcept {
    left_ -= part.work;
    deadline_ -= part.time;
  }
  void give_back(const Part& part) noexcept {
    const std::uint64_t overshoot = std::min(beyond_, part.work);  // taken from the part, or overshoots would add up
    left_ += part.work - overshoot, beyond_ -= overshoot;
    deadline_ += part.time;
  }

  bool limited() const noexcept { return limited_in_work() || timed() || replay_ != nullptr; }
  // Returns a budget of its own with one of `among` equal shares of what is left, rounded up.
  StepBudget share(std::uint64_t among) const noexcept {
    Budget part;
    if (limited_) part.work = left_ / among + (left_ % among != 0 ? 1 : 0);
    if (timed_) part.time = time_left() / static_cast<std::int64_t>(among);
    return {part, replay_};
  }

  const StepCut* replay() const noexcept { return replay_; }
  const StepCut& cut() const noexcept { return cut_; }
  // The next functions return whether the step may go on with one of its stages. If not, cut() has the place.
  // - The quick test of another pair of parts: may_go_on() asks about it, and may_begin() also counts it.
  bool may_go_on() noexcept { return left() > 0 && reaches(&StepCut::begun, begun_); }
  bool may_begin() noexcept {
    const bool may = reaches(&StepCut::begun, begun_);
    begun_ += may ? 1 : 0;
    return may;
  }
  // - Another search, which refined() counts when it is done.
  bool may_refine() noexcept { return left() > 0 && reaches(&StepCut::refined, refined_); }
  // - The sweep with this number, from 0.
  bool may_sweep(std::uint64_t pair) noexcept { return left() > 0 && reaches(&StepCut::swept, pair); }
  // Returns the limit of work for the next search: `slice` or, in a replay, at most what is left up to the cut.
  std::uint64_t piece(std::uint64_t slice) const noexcept {
    return replay_ == nullptr ? slice : std::min(slice, replay_->refined - refined_ - 1);
  }
  void refined(std::uint64_t work) noexcept { refined_ += work + 1; }
  void cut_broad(std::uint64_t work) noexcept { cut_.broad = work; }

 private:
  // Returns whether a stage that has done so much may go on, and notes the cut if it may not.
  bool reaches(std::uint64_t StepCut::*stage, std::uint64_t done) noexcept {
    const bool stop = replay_ != nullptr ? done >= replay_->*stage : late();
    if (stop) cut_.*stage = std::min(cut_.*stage, done);
    return !stop;
  }

  std::uint64_t left_, beyond_ = 0, spent_ = 0;  // beyond_: the work that was spent when nothing was left
  bool limited_, timed_ = false;
  Clock::time_point deadline_{};
  const StepCut* replay_;
  StepCut cut_;
  std::uint64_t begun_ = 0, refined_ = 0;
};

}  // namespace orchard::runtime::detail
