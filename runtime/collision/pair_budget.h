#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>

#include "orchard/runtime/narrow_phase.h"

namespace orchard::runtime {

// The budget of one call, and what it has spent. It looks at the clock only every kClockInterval tests.
class PairBudget {
 public:
  explicit PairBudget(const Budget& budget) noexcept : limit_(budget.work) {
    if (budget.time < std::chrono::hours(24 * 365)) {  // more is no limit, and would overflow the clock
      next_clock_ = kClockInterval;
      deadline_ = std::chrono::steady_clock::now() + budget.time;
    }
  }
  bool exhausted() noexcept {  // once it is true, it stays true
    if (spent_ >= next_clock_) look_at_clock();
    return spent_ >= limit_;
  }
  // Returns how many rows of `tests` tests each may be done before the limits have to be checked again; at least one.
  std::uint32_t rows(std::uint32_t tests) const noexcept {
    const std::uint64_t left = std::min(limit_, next_clock_) - spent_;
    if (left >= std::uint64_t{kBlockWidth} * kBlockWidth) return kBlockWidth;  // saves a division
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(kBlockWidth, (left - 1) / tests + 1));
  }
  void spend(std::uint64_t tests) noexcept { spent_ += tests; }
  std::uint64_t spent() const noexcept { return spent_; }

 private:
  void look_at_clock() noexcept {
    next_clock_ = spent_ + kClockInterval;
    if (std::chrono::steady_clock::now() >= deadline_) limit_ = std::min(limit_, spent_);
  }
  std::uint64_t limit_, spent_ = 0, next_clock_ = std::numeric_limits<std::uint64_t>::max();
  std::chrono::steady_clock::time_point deadline_;
};

}  // namespace orchard::runtime
