#pragma once
#include "broad_phase/budgeted_work.h"
#include "broad_phase/planner.h"
#include "broad_phase/sorted_spheres.h"

namespace orchard::runtime::detail {

// The default method. Each body is updated once per window of steps: a box around all that its bound allows until the
// window's end goes into a grid, and every other body whose box it meets makes a near pair. A near pair has an event at
// the first step at which the two bounds can touch; no event lies beyond the earlier end of the two windows, as the
// update due there finds the pair again. A pair that overlaps has an event at the first step at which it can have
// parted; until then it stays in the list that is reported.
//
// Where bounds are cancelled at every step, windows have one step. Where none is longer, boxes and events are of no
// use: the spheres are sorted again at each step.
//
// Where most windows end at one step, the *common expiry*, all boxes are rebuilt then, and half of that work is done
// a step ahead: a bound that holds up to the step before the common expiry still answers for it, while the next bound
// is known already.
//
// Here is what a step does and when everything is rebuilt; each part owns what it needs for that.
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
  bool worth_a_rebuild(std::size_t due) const noexcept;
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
  Step interrupted_at_ = kNeverStep / -2;    // by a budget
  bool prepared_ = false;                    // half of the updates for the next step have been done ahead
  Step common_expiry_ = kNeverStep;          // the step at which most windows end
  struct Due {                               // at the step under way
    std::vector<BodyIndex> bodies, entries;  // entries: what the wheel had for it
    std::vector<PairEvent> pairs;            // that wait for their tests
  };
  Due due_;
};

}  // namespace orchard::runtime::detail
