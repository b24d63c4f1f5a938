#pragma once
#include "broad_phase/window_plan.h"

namespace orchard::runtime::detail {

// So few bodies say little of how often bounds are cancelled: a step or two in which all were may be all there is.
inline constexpr std::size_t kFewBodies = 192;

// Decides, at updates of all windows, how long windows and how large cells are from then on: by the density and the
// motion of a sample of the bodies, corrected by the pairs that were seen, and by how often bounds are cancelled.
class Planner {
 public:
  Planner(BodyPool& pool, const BroadPhaseOptions& options) : pool_(pool), options_(options) {}

  const WindowPlan& plan() const noexcept { return plan_; }
  const Spread& spread() const noexcept { return spread_; }    // of the bodies, when the plan was made
  const Vec3& velocity() const noexcept { return velocity_; }  // of the crowd, if all fly the same way
  void note_cancelled() noexcept { ++cancellations_; }         // bounds, or a body removed

  bool crowded(const GridCounts& counts) const noexcept;
  bool many_more_bodies() const noexcept { return pool_.size() > 2 * planned_bodies_; }
  enum class Outcome : std::uint8_t {
    interrupted,  // by a budget, which ended the survey before it was complete: it goes on at the next call
    same,
    rebuild
  };
  // `counts`: of the grid since the last call.
  Outcome replan(Step now, const GridCounts& counts, BudgetTracker& tracker);
  void forget_survey() noexcept { sample_.clear(); }
  // Of the bodies, so that two steps take the same time if so many are updated ahead.
  double share_ahead() const noexcept;
  std::size_t memory_bytes() const noexcept { return bytes_of(sample_); }

 private:
  bool outdated(double off, double cancelled) noexcept;
  bool survey(Step now, BudgetTracker& tracker);

  BodyPool& pool_;
  const BroadPhaseOptions& options_;
  WindowPlan plan_;
  Spread spread_;
  Vec3 velocity_{};
  double crowding_ = 1, correction_ = 1;
  std::size_t cancellations_ = 0;  // since the plan was made
  double cancelled_ = 0;           // the share of the bodies at each step that it was made for
  Step planned_at_ = 0;
  std::size_t planned_bodies_ = 0;
  unsigned plans_ = 0;
  std::vector<Motion> sample_;  // of a survey under way
  BodyIndex survey_next_ = 0;
};

}  // namespace orchard::runtime::detail
