#pragma once
#include "broad_phase/budgeted_work.h"
#include "broad_phase/planner.h"
#include "broad_phase/sorted_spheres.h"

namespace orchard::runtime::detail {

// The default algorithm. Each body is updated once per window of steps. An update makes a box around all places that
// the motion bound of the body allows until the window ends, and inserts it into a grid. Every body whose box it meets
// there forms a near pair with it. A near pair has an event at the first step at which the two bounds can touch. No
// event lies beyond the earlier end of the two windows, because the update that is due there finds the pair again. A
// pair that overlaps has an event at the first step at which it can have parted; until then, it stays in the list that
// is reported.
//
// If bounds are cancelled at every step, windows have one step. If no window is longer, boxes and events have no use:
// the spheres are sorted again at each step.
//
// If most windows end at one step, the *common expiry*, all boxes are rebuilt there, and about half of that work is
// done one step ahead. That step can do it because a bound that holds up to the step before the common expiry still
// answers for it, while the next bound is already known.
//
// This class decides what a step does and when everything is rebuilt. Each part owns the state that it needs for its
// task.
class KineticBroadPhase final : public BroadPhaseAlgorithm {
 public:
  KineticBroadPhase(BodyPool& pool, const BroadPhaseOptions& options);

  void changed(BodyIndex body) override;
  void removed(BodyIndex body) override;
  void reclassified(BodyIndex body) override { budgeted_.reclassified(body); }
  StepReport step(Step now, BudgetTracker& tracker) override;
  void skip() noexcept override { prepared_ = false, common_expiry_ = kNeverStep; }
  std::size_t memory_bytes() const noexcept override;
  std::size_t predict_load(Step now, std::span<StepsAhead> steps) const noexcept override;
  Near near_box(Step now, const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const override;
  bool along(Step now, const Vec3& origin, const Vec3& way, double length, std::vector<BodyIndex>& portion,
             const VisitPortion& visit) const override;
  double cell_size() const noexcept override { return planner_.plan().cell_size; }

 private:
  void forget_all() noexcept;
  void begin(Step now);
  void collect_due(Step now);
  void complete_due();
  void take_changes();
  StepReport end(Step now, unsigned incomplete_from, const BudgetTracker& tracker);

  void step_in_full(Step now, bool completing);
  unsigned step_within(Step now, BudgetTracker& tracker);
  void step_by_sorting(Step now);
  Step find_common_expiry(Step now) const noexcept;
  bool worth_a_rebuild(Step now, std::size_t due) const noexcept;
  bool worth_sorting(Step now) const noexcept;
  bool prepare(Step now);

  bool replan(Step now, BudgetTracker& tracker);
  void all_are_due();
  void place_all();
  void begin_sorting();
  void make_room_for_boxes();
  void note_spheres();
  void append_loose(std::vector<BodyIndex>& bodies) const;

  KineticState state_;
  Planner planner_;
  NearPairs pairs_;
  WindowUpdates updates_;
  BudgetedWork budgeted_;
  SortedSpheres sorted_;

  bool sorting_ = false;               // the last step was done by sorting: there are no boxes, and all bodies are due
  Step sorts_from_ = kNeverStep / -2;  // at steps before, nothing is sorted
  Step interrupted_at_ = kNeverStep / -2;    // by a budget, at the last such step
  bool prepared_ = false;                    // half of the updates for the next step have been done ahead
  Step common_expiry_ = kNeverStep;          // the step at which most windows end
  struct Due {                               // what is due at the step under way
    std::vector<BodyIndex> bodies, entries;  // entries: the bodies that the timing wheel had for it
    std::vector<PairEvent> pairs;            // pairs that wait for their tests
  };
  Due due_;
};

}  // namespace orchard::runtime::detail
