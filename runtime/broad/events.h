#pragma once
#include "backlog.h"
#include "box_list.h"
#include "method.h"
#include "overlap_list.h"
#include "sorted_spheres.h"
#include "swept_grid.h"
#include "window_plan.h"

namespace orchard::runtime::detail {

// The default method. Each body is updated once per window of steps: a box around all that its bound allows until the
// window's end goes into a grid, and every other body whose box it meets makes a near pair. A near pair has an event at
// the first step at which the two bounds can touch; no event lies beyond the earlier end of the two windows, as the
// update due there finds the pair anew. A pair that overlaps has an event at the first step at which it can have
// parted; until then it stays in the list that is reported.
//
// A body whose bounds are cancelled at every step gets windows of one step, and longer ones again once these go well.
//
// Where most windows end at one step, the *common expiry*, all boxes are made anew then, and half of that work is done
// a step ahead: a bound that holds up to the step before the common expiry still answers for it, while the next bound
// is known already.
class Events final : public Method {
 public:
  Events(BodyPool& pool, const BroadPhaseOptions& options) : pool_(pool), options_(options) {}

  void changed(BodyIndex body) override;
  void removed(BodyIndex body) noexcept override;
  void reclassified(BodyIndex body) override;
  StepReport step(Step now, BudgetTracker& tracker) override;
  std::size_t memory_bytes() const noexcept override;
  std::size_t foresee(Step now, std::span<StepsAhead> steps) const noexcept override;
  Near near_box(Step now, const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const override;
  bool along(Step now, const Vec3& origin, const Vec3& way, double length, std::vector<BodyIndex>& portion,
             PortionVisitor& visitor) const override;
  double cell_size() const noexcept override { return plan_.cell_size; }

 private:
  enum class Place : std::uint8_t { nowhere, inside, oversized };
  struct Window {
    Step end = 0;                         // the step of the next update
    Round updated = 0;                    // the round of the last update: events of earlier rounds are void
    std::uint8_t length = 0;              // steps; 0: not known
    std::uint8_t lasting = kLastsAsEver;  // steps that bounds are relied on for, at most

    void rely_longer() noexcept { lasting = lasting < kLastsAsEver / 4 ? lasting * 4 : kLastsAsEver; }
  };
  // What a window update takes note of where many pairs are near: most of them need no other test.
  struct Sphere {
    Vec3 center;
    double radius, reach;  // reach: as far as the centre may get until the body's window ends, and all slack
  };
  enum class Found : std::uint8_t { tested, kept };  // near pairs that a window update finds
  struct WindowUpdate;
  static constexpr std::size_t kMinBodiesAtCommonExpiry = 32;  // bodies that are worth a step more
  static constexpr Step kMinStepsBeforeCommonExpiry =
      4;  // steps: half of a window update ahead of each would be half a window update more
  static constexpr std::size_t kTestsAtOnce = kBlock / 2;
  static constexpr QuantumBox kNothing = {{kLastQuantum, kLastQuantum, kLastQuantum}, {0, 0, 0}};
  static constexpr std::size_t kNearAtOnce = 1024;  // near pairs that are tested together
  static constexpr Step kUpdateDue = -1;            // a window's end while its body waits for a window update
  static constexpr std::uint8_t kLastsAsEver = static_cast<std::uint8_t>(kLongestWindow - 1);

  // events.cpp: a step
  void make_room();
  void forget_all() noexcept;
  void collect_due(Step now);
  void complete_due(Step now);
  void take_away(BodyIndex body) noexcept;
  void take_away_due() noexcept;
  void make_room_for_boxes();
  void make_room_for_spheres();
  bool outgrown() const noexcept { return few_ && pool_.slots() > BoxList::kMaxBodies; }
  void step_in_full(Step now, bool completing);
  void test_due(Step now);
  void void_events(BodyIndex body) noexcept;
  void note_cancelled(Window& window, Step now) noexcept;

  // events_sorting.cpp: where windows are of one step
  void collect_all(Step now);
  bool worth_sorting(Step now) const noexcept;
  void begin_sorting();
  void step_by_sorting(Step now);

  // events_budget.cpp: a step within a budget
  void postpone(BodyIndex body);
  void keep_doubtful();
  void sort_pairs_again();
  void join_backlog();
  bool worth_a_rebuild_within(Step now, std::size_t due) const noexcept;
  unsigned step_within(Step now, BudgetTracker& tracker);
  bool work_through(Step now, unsigned importance, BudgetTracker& tracker);
  std::size_t update_waiting(Step now, unsigned importance, std::size_t most, BudgetTracker& tracker);
  std::size_t test_waiting(Step now, PairQueue& queue, bool found, std::size_t most, BudgetTracker& tracker);

  // events_plan.cpp: updates of all windows
  bool crowded(const GridCounts& counts) const noexcept;
  bool worth_a_rebuild(std::size_t due) const noexcept;
  bool rounds_run_out() const noexcept { return is_later(round_, rebuilt_round_ + kFarthestRound); }
  bool replan(Step now, BudgetTracker& tracker);
  bool plan_outdated(double off, double cancelled) noexcept;
  bool survey(Step now, BudgetTracker& tracker);
  Vec3 frame_velocity() const noexcept;
  double seconds_between(Step begin, Step end) const noexcept {
    return static_cast<double>(end - begin) * options_.time_step;
  }
  void all_are_due();
  void place_all_anew();
  bool prepare(Step now);
  double share_ahead() const noexcept;
  void vote(Step end, std::size_t bodies) noexcept;

  // events_update.cpp: updates of some windows
  void update_windows(Step now, Step from, std::span<const BodyIndex> bodies, Found found);
  void test_near(Step now);
  bool settle_by_spheres(Step now, const BodyPair& pair);
  double reach_of(const Motion& motion, double duration) const noexcept;
  std::size_t known_at(Step from, std::span<BodyIndex> bodies) noexcept;
  Step window_end(Step from, const Motion& motion) noexcept;
  Step window_end(Step from, BodyIndex body, const Motion& motion) noexcept;
  std::size_t refuse_invalid(std::span<BodyIndex> bodies);
  void refuse(BodyIndex body);
  bool place(WindowUpdate& update, std::span<const BodyIndex> bodies);
  bool place_in_grid(WindowUpdate& update, std::span<const BodyIndex> bodies);
  void note_extent(const BoxBlock& boxes, std::size_t count) noexcept;
  void shrink(WindowUpdate& update, BodyIndex body, std::size_t i);
  void insert(WindowUpdate& update, std::span<const BodyIndex> bodies);
  void meet_oversized(std::span<const BodyIndex> bodies);
  void drop_what_is_none();

  // events_queries.cpp
  struct GridRay;
  void append_loose(std::vector<BodyIndex>& bodies) const;
  void append_in_cells(const QuantumBox& box, std::vector<BodyIndex>& bodies) const;
  Lattice lattice_at(Step now) const noexcept;
  bool walk_slabs(const GridRay& ray, std::vector<BodyIndex>& portion, PortionVisitor& visitor) const;

  // events_pairs.cpp
  bool valid(const PairEvent& event) const noexcept;
  // Up to the next update of its window. One that waits for it is known by its present motion only, which holds on its
  // own.
  Step known_until(BodyIndex body, Step now) const noexcept {
    const Step end = windows_[body].end;
    return end == kUpdateDue ? now + kLongestWindow : end;
  }
  void test(Step now, std::span<const PairEvent> events);
  void settle(Step now, const PairEvent& event, const Motion& a, const Motion& b);
  void settle_touching(Step now, const PairEvent& event, Step left, Step sure);

  BodyPool& pool_;
  const BroadPhaseOptions options_;

  std::vector<Window> windows_;  // by body
  std::vector<Place> places_;
  std::vector<std::uint8_t> pending_;  // changed since the last step
  std::vector<QuantumBox> boxes_;      // of those in the grid
  std::vector<BodyIndex> changed_, oversized_;
  bool any_short_ = false;  // windows, of bodies whose bounds are cancelled again and again
  bool few_ = true;         // bodies: they are in the list, not in the grid
  BoxList list_;
  SweptGrid grid_;
  bool sorting_ = false;  // the last step was done by sorting: no body is in the list nor in the grid, and all are due
  Step sorts_from_ = kNeverStep / -2;  // at steps before, nothing is sorted
  SortedSpheres sorted_;
  QuantumBox extent_ = kNothing;  // around all boxes that are in the grid, or have been since all were placed anew
  Lattice lattice_;
  Step lattice_from_ = 0;  // at which it was made
  TimingWheel wheel_;
  OverlapList overlaps_;
  std::vector<PairEvent> overlaps_ahead_;  // of pairs tested ahead for the next step, at which they surely touch
  Backlog backlog_;                        // what budgets have left over
  std::vector<PairEvent> doubtful_;  // reported within a budget, before another update that may not have found them yet
  bool reclassified_ = false;        // some body, since the last step within a budget
  Step interrupted_at_ = kNeverStep / -2;

  WindowPlan plan_;
  MotionMeans means_;
  double spacing_ = 0, crowding_ = 1, correction_ = 1;
  std::size_t cancellations_ = 0;  // of bounds, and removals, since the plan was made
  double cancelled_ = 0;           // the share of the bodies at each step that it was made for
  Step planned_at_ = 0;
  std::size_t planned_bodies_ = 0;
  unsigned plans_ = 0;
  std::vector<Motion> surveyed_;  // the sample of a survey under way
  BodyIndex survey_next_ = 0;

  Round round_ = 0;                  // of updates
  Round rebuilt_round_ = 0;          // in which all were to be updated
  bool prepared_ = false;            // half of the updates for the next step have been done ahead
  Step common_expiry_ = kNeverStep;  // the step at which most windows end
  Step voted_ = kNeverStep;
  std::size_t votes_ = 0;

  // Of the step under way; kept for their memory.
  std::vector<BodyIndex> entries_, due_;
  std::vector<PairEvent> waiting_, tests_;
  std::vector<BodyPair> near_;
  std::vector<Sphere> spheres_;  // by body; empty unless many pairs are near
  bool preparing_ = false, limited_ = false;
  std::vector<Motion> motions_;
  Step last_from_ = -1, last_end_ = 1;
  double last_expiry_ = 0;
};

}  // namespace orchard::runtime::detail
