#pragma once
#include "broad_phase/broad_phase_algorithm.h"
#include "sleeping_broad_phase.h"
#include "space_time_bound.h"

namespace orchard::broad_phase_methods::detail {

using runtime::BodyIndex;
using runtime::BodyPair;
using runtime::kNoClass;
using runtime::kNoIndex;
using runtime::detail::BodyPool;
using runtime::detail::BudgetTracker;
using runtime::detail::bytes_of;
using runtime::detail::kNeverStep;
using runtime::detail::Step;
using runtime::detail::StepReport;

// The dissertation's broad phase (Fig. 4.23): sleep until the earliest two bounds touch, rebuild, and look again. While
// bounds touch it goes on step by step, and reports the pairs whose spheres really overlap.
class Sleeping final : public runtime::detail::BroadPhaseAlgorithm {
 public:
  Sleeping(BodyPool& pool, const SleepingOptions& options);

  void changed(BodyIndex body) override;
  void removed(BodyIndex) noexcept override { members_changed_ = true; }
  void reclassified(BodyIndex) override {}
  StepReport step(Step now, BudgetTracker& tracker) override;
  std::size_t memory_bytes() const noexcept override;

 private:
  struct Known {
    Motion motion;
    Step asked = -1;  // the step that the motion is of; -1: to be asked for
    Step end = 0;     // the first step at which it does not hold
    bool valid = true;
  };
  // Whose turn it is in a class, when a budget does not suffice for all.
  struct Turn {
    BodyIndex body = kNoIndex;             // asked for last
    BodyPair pair = {kNoIndex, kNoIndex};  // asked for last
    std::int64_t lead = 0;                 // units of work that new bounds are ahead of pairs
  };

  void refresh_members();
  bool stale(BodyIndex body, Step now) const noexcept { return known_[body].asked < 0 || known_[body].end <= now; }
  bool current(BodyIndex body, Step now) const noexcept { return known_[body].asked == now || pool_.statics.has(body); }
  void ask(Step now, std::span<const BodyIndex> bodies);
  void find(Step now);
  bool intersecting_are_current(Step now);
  void report(Step now);
  StepReport sleep(Step now);

  // sleeping_budget.cpp
  StepReport step_within(Step now, BudgetTracker& tracker);
  bool work_through(Step now, unsigned importance, BudgetTracker& tracker);
  void collect_stale(Step now, unsigned importance);
  void collect_pairs(Step now, unsigned importance);
  void ask_in_turn(Step now, Turn& turn, std::uint64_t most, BudgetTracker& tracker);
  void test_in_turn(Step now, Turn& turn, std::uint64_t most, BudgetTracker& tracker);
  std::size_t left_over(Step now) const noexcept;

  BodyPool& pool_;
  const bool rebuild_all_;
  const double slack_;  // of a body's bound
  const IntersectionOptions find_;
  IntersectionFinder finder_;
  std::vector<Known> known_;  // by body
  std::vector<BodyIndex> members_, stale_;
  std::vector<Motion> motions_;
  std::vector<BodyPair> pairs_;  // that touch, as far as is known, but are not all of now
  std::vector<BodyPair> reported_;
  std::vector<Turn> turns_;             // by class
  std::vector<BodyIndex> present_;      // the members whose bounds hold
  std::vector<SpaceTimeBound> bounds_;  // by place in present_
  const Intersections* found_ = nullptr;
  Step end_ = 0;  // the first step at which not all the bounds hold
  bool members_changed_ = true;
};

}  // namespace orchard::broad_phase_methods::detail
