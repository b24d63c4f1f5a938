#pragma once
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "orchard/runtime/detector.h"

namespace orchard::runtime::detail {

// What steps have cost lately, smoothed: for Detector::predict_load(), and for the time that a budget has to set aside.
class LoadModel {
 public:
  // The pairs of a step, against those of the step before: `meetings` the timing wheel had announced, `known` there
  // were, `fresh` came and `parted` went.
  struct Pairs {
    double meetings = 0;
    std::size_t known = 0, fresh = 0, parted = 0;
  };
  void learn_pairs(const Pairs& seen, std::uint64_t work, std::size_t pairs) noexcept;
  // In nanoseconds, of a step with a budget in time and `pairs` pairs: what each step does before and after choosing
  // which ones to answer; and by how much the broad phase exceeded the time that it was given.
  void learn_times(double before, double after, std::size_t pairs) noexcept;
  void learn_broad_excess(double time) noexcept;

  // Fills in what the steps of `ahead` are likely to cost, but for their times; `pairs` overlap now.
  void predict(std::span<const StepsAhead> ahead, std::size_t pairs, std::span<StepLoad> loads) const noexcept;
  // Half of what is left for choosing: not of what each step does in any case, for every pair and to end the broad
  // phase.
  std::chrono::nanoseconds time_for_broad(std::chrono::nanoseconds left, std::size_t pairs) const noexcept;
  std::chrono::nanoseconds time_to_report(std::size_t pairs) const noexcept;

 private:
  // Of the meetings of the timing wheel, the share that overlaps; of the pairs that overlap, the share that does no
  // more at the next step; what a pair costs.
  double share_of_meetings_ = 0.5, share_that_part_ = 0.1, work_per_pair_ = 200;
  double before_pair_ = 200, after_pair_ = 100, broad_excess_ = 0;  // ns
};

}  // namespace orchard::runtime::detail
