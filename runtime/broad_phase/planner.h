#pragma once
#include "broad_phase/window_plan.h"

namespace orchard::runtime::detail {

// With at most this number of bodies, one or two steps do not show how often bounds are cancelled: it may be by chance
// that all of them were.
inline constexpr std::size_t kFewBodies = 192;

// Chooses, when all windows are updated, the length of windows and the size of cells. It uses the density and the
// motion of a sample of the bodies, a correction by the number of pairs that were found, and the share of the bounds
// that are cancelled.
class Planner {
 public:
  Planner(BodyPool& pool, const BroadPhaseOptions& options) : pool_(pool), options_(options) {}

  const WindowPlan& plan() const noexcept { return plan_; }
  const Spread& spread() const noexcept { return spread_; }    // of the bodies when the plan was made
  const Vec3& velocity() const noexcept { return velocity_; }  // the common velocity of most bodies, or 0
  void note_cancelled() noexcept { ++cancellations_; }         // bounds were cancelled, or a body was removed

  // Returns whether the lines of the grid are so full that smaller cells are better.
  bool crowded(const GridCounts& counts) const noexcept;
  bool many_more_bodies() const noexcept { return pool_.size() > 2 * planned_bodies_; }
  enum class Outcome : std::uint8_t {
    interrupted,  // a budget ended the survey of the bodies; the next call continues it
    same,         // the plan has not changed
    rebuild       // there is a new plan
  };
  // Makes a new plan if the old one does not fit any more. `counts` are those of the grid since the last call.
  Outcome replan(Step now, const GridCounts& counts, BudgetTracker& tracker);
  void forget_survey() noexcept { sample_.clear(); }
  // Returns the share of the bodies that is updated a step ahead of a common expiry, so that both steps take about the
  // same time.
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
  double cancelled_ = 0;           // the share of the bodies that is cancelled at each step, as the plan assumes
  Step planned_at_ = 0;
  std::size_t planned_bodies_ = 0;
  unsigned plans_ = 0;
  std::vector<Motion> sample_;  // of the survey under way
  BodyIndex survey_next_ = 0;
};

}  // namespace orchard::runtime::detail
