#pragma once
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "orchard/runtime/detector.h"

namespace orchard::runtime::detail {

// The smoothed costs of recent steps. They predict the load, for Detector::predict_load(), and the time that a budget
// has to set aside.
class LoadModel {
 public:
  // How the pairs of a step differ from those of the step before.
  struct Pairs {
    double meetings = 0;  // as predicted: StepsAhead::meetings
    // The numbers of pairs at the step before, of new pairs, and of pairs of the step before that are none any more.
    std::size_t known = 0, fresh = 0, parted = 0;
  };
  // Learns from a step that had `pairs` pairs and spent `work` on them.
  void learn_pairs(const Pairs& seen, std::uint64_t work, std::size_t pairs) noexcept;
  // Learns from a step with a budget in time and `pairs` pairs how long the work takes that every step has to do, in
  // nanoseconds: `before` it chooses which pairs to answer, and `after` they are answered.
  void learn_times(double before, double after, std::size_t pairs) noexcept;
  // Learns by how much, in nanoseconds, the broad phase exceeded the time that it was given.
  void learn_broad_excess(double time) noexcept;

  // Predicts what the steps of `ahead` cost, if `pairs` pairs overlap now. Fills in all of StepLoad except the time.
  void predict(std::span<const StepsAhead> ahead, std::size_t pairs, std::span<StepLoad> loads) const noexcept;
  // Returns the time for the broad phase. It is half of what remains of `left` after the work that every step has to do
  // for `pairs` pairs, less the time by which the broad phase exceeds its limit.
  std::chrono::nanoseconds time_for_broad(std::chrono::nanoseconds left, std::size_t pairs) const noexcept;
  // Returns the time that the work after the answers takes for `pairs` pairs.
  std::chrono::nanoseconds time_to_report(std::size_t pairs) const noexcept;

 private:
  // The share of the predicted meetings that overlap, the share of the pairs that do not overlap any more at the next
  // step, and the work for a pair.
  double share_of_meetings_ = 0.5, share_that_part_ = 0.1, work_per_pair_ = 200;
  double before_pair_ = 200, after_pair_ = 100, broad_excess_ = 0;  // ns
};

}  // namespace orchard::runtime::detail
