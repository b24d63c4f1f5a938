#include "detector/load_model.h"

namespace orchard::runtime::detail {

namespace {

constexpr double kSmoothing = 0.1;              // of the costs that predict() uses
constexpr double kSlower = 0.5, kFaster = 0.1;  // of times; one that is longer than expected is learned sooner
// A time counts as at most twice the mean, or as at most this much more than the mean, whichever is larger. Otherwise,
// one step that the machine interrupts for milliseconds would dominate many that follow.
constexpr double kMaxGrowthOfPair = 20, kMaxGrowthOfBroad = 5000;  // ns

void smooth(double& mean, double value) noexcept { mean += kSmoothing * (value - mean); }

void learn_time(double& mean, double value, double max_growth) noexcept {
  const double believed = std::clamp(value, 0.0, std::max(2 * mean, mean + max_growth));
  mean += (believed > mean ? kSlower : kFaster) * (believed - mean);
}

double at_least_one(std::size_t pairs) noexcept { return static_cast<double>(std::max<std::size_t>(1, pairs)); }

}  // namespace

void LoadModel::learn_pairs(const Pairs& seen, std::uint64_t work, std::size_t pairs) noexcept {
  if (pairs > 0) smooth(work_per_pair_, static_cast<double>(work) / static_cast<double>(pairs));
  if (seen.meetings > 0) smooth(share_of_meetings_, std::min(1.0, static_cast<double>(seen.fresh) / seen.meetings));
  if (seen.known > 0) smooth(share_that_part_, static_cast<double>(seen.parted) / static_cast<double>(seen.known));
}

void LoadModel::learn_times(double before, double after, std::size_t pairs) noexcept {
  learn_time(before_pair_, before / at_least_one(pairs), kMaxGrowthOfPair);
  learn_time(after_pair_, after / at_least_one(pairs), kMaxGrowthOfPair);
}

void LoadModel::learn_broad_excess(double time) noexcept { learn_time(broad_excess_, time, kMaxGrowthOfBroad); }

// The share of meetings that overlap, the share of pairs that part and the work for a pair are assumed to stay as they
// were at recent steps.
void LoadModel::predict(std::span<const StepsAhead> ahead, std::size_t pairs,
                        std::span<StepLoad> loads) const noexcept {
  double overlaps = static_cast<double>(pairs);
  for (std::size_t i = 0; i < ahead.size(); ++i) {
    overlaps += share_of_meetings_ * static_cast<double>(ahead[i].meetings);
    loads[i].motions = ahead[i].updates + 2 * ahead[i].meetings + 2 * ahead[i].overlaps;
    loads[i].pairs = overlaps;
    loads[i].work = overlaps * work_per_pair_ + static_cast<double>(loads[i].motions * kMotionWork);
    overlaps -= share_that_part_ * overlaps;
  }
}

std::chrono::nanoseconds LoadModel::time_for_broad(std::chrono::nanoseconds left, std::size_t pairs) const noexcept {
  const double in_any_case = (before_pair_ + after_pair_) * static_cast<double>(pairs);
  const double time = (static_cast<double>(left.count()) - in_any_case) / 2 - broad_excess_;
  return std::chrono::nanoseconds(static_cast<std::int64_t>(std::max(0.0, time)));
}

std::chrono::nanoseconds LoadModel::time_to_report(std::size_t pairs) const noexcept {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(after_pair_ * at_least_one(pairs)));
}

}  // namespace orchard::runtime::detail
