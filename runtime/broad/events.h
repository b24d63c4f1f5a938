#pragma once
#include "backlog.h"
#include "box_list.h"
#include "method.h"
#include "swept_grid.h"
#include "window_plan.h"

namespace orchard::runtime::detail {

// The default method. Each body is looked at once per window of steps: a box around all that its bound allows until the
// window's end goes into a grid, and every other body whose box it meets makes a near pair. A near pair has an event at
// the first step at which the two bounds can touch; no event lies beyond the earlier end of the two windows, as the
// look due there finds the pair anew. Overlapping pairs are tested at every step at which they can have parted.
//
// Where most windows end at one step, the *rush*, all boxes are made anew then, and half of that work is done a step
// ahead: a bound that holds up to the step before the rush still answers for it, while the next bound is known already.
class Events final : public Method {
 public:
  Events(Roster& roster, const BroadPhaseOptions& options) : roster_(roster), options_(options) {}

  void changed(BodyIndex body) override;
  void removed(BodyIndex body) noexcept override;
  void reclassified(BodyIndex body) override;
  StepReport step(Step now, Meter& meter, std::vector<BodyPair>& pairs) override;
  std::size_t memory_bytes() const noexcept override;
  std::size_t foresee(Step now, std::span<StepsAhead> steps) const noexcept override;
  Near near_box(const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const override;
  bool along(const Vec3& origin, const Vec3& way, double length, std::vector<BodyIndex>& portion,
             PortionVisitor& visitor) const override;
  double cell_size() const noexcept override { return plan_.cell_size; }

 private:
  enum class Place : std::uint8_t { nowhere, inside, oversized };
  struct Window {
    Step looked = -1;  // the round of the last look: events of earlier rounds are void
    Step end = 0;      // the step of the next look
  };
  struct Look;
  static constexpr std::size_t kFewestInRush = 32;  // bodies that are worth a step more
  static constexpr std::size_t kTestsAtOnce = kBlock / 2;
  static constexpr QuantumBox kNothing = {{kLastQuantum, kLastQuantum, kLastQuantum}, {0, 0, 0}};
  static constexpr Step kLookDue = -1;  // a window's end while its body waits for a look

  // events.cpp: a step
  void make_room();
  void forget_all() noexcept;
  void collect_due(Step now);
  void complete_due();
  void take_away(BodyIndex body) noexcept;
  void take_away_due() noexcept;
  void make_room_for_boxes();
  bool outgrown() const noexcept { return few_ && roster_.slots() > BoxList::kMostBodies; }
  void step_in_full(Step now, bool completing);
  void report(std::vector<BodyPair>& pairs);

  // events_budget.cpp: a step within a budget
  void postpone(BodyIndex body);
  void sort_pairs_again();
  void join_backlog(Step now);
  bool worth_a_rebuild_within(Step now, std::size_t due) const noexcept;
  unsigned step_within(Step now, Meter& meter);
  bool work_through(Step now, unsigned importance, Meter& meter);
  std::size_t look_at_waiting(Step now, unsigned importance, std::size_t most, Meter& meter);
  std::size_t test_waiting(Step now, PairQueue& queue, bool found, std::size_t most, Meter& meter);

  // events_plan.cpp: looks at all bodies
  bool crowded(const GridCounts& counts) const noexcept;
  bool worth_a_rebuild(std::size_t due) const noexcept;
  bool replan(Step now, Meter& meter);
  bool survey(Step now, Meter& meter);
  void place_all_anew();
  bool prepare(Step now);
  void vote(Step end, std::size_t bodies) noexcept;

  // events_look.cpp: a look at some
  void look_at(Step now, Step from, std::span<const BodyIndex> bodies);
  std::size_t known_at(Step from, std::span<BodyIndex> bodies) noexcept;
  Step window_end(Step from, const Motion& motion) noexcept;
  std::size_t refuse_invalid(std::span<BodyIndex> bodies);
  void refuse(BodyIndex body);
  bool place(Look& look, std::span<const BodyIndex> bodies);
  bool place_in_grid(Look& look, std::span<const BodyIndex> bodies);
  void note_extent(const BoxBlock& boxes, std::size_t count) noexcept;
  void shrink(Look& look, BodyIndex body, std::size_t i);
  void insert(Look& look, std::span<const BodyIndex> bodies);
  void meet_oversized(std::span<const BodyIndex> bodies);
  void drop_what_is_none();

  // events_queries.cpp
  struct GridRay;
  void append_loose(std::vector<BodyIndex>& bodies) const;
  void append_in_cells(const QuantumBox& box, std::vector<BodyIndex>& bodies) const;
  bool walk_slabs(const GridRay& ray, std::vector<BodyIndex>& portion, PortionVisitor& visitor) const;

  // events_pairs.cpp
  bool valid(const PairEvent& event) const noexcept;
  Step known_until(BodyIndex body, Step now) const noexcept;
  void test(Step now, std::span<const PairEvent> pairs);
  void settle(Step now, const BodyPair& pair, const Motion& a, const Motion& b);

  Roster& roster_;
  const BroadPhaseOptions options_;

  std::vector<Window> windows_;  // by body
  std::vector<Place> places_;
  std::vector<std::uint8_t> pending_;  // changed since the last step
  std::vector<QuantumBox> boxes_;      // of those in the grid
  std::vector<BodyIndex> changed_, oversized_;
  bool few_ = true;  // bodies: they are in the list, not in the grid
  BoxList list_;
  SweptGrid grid_;
  QuantumBox extent_ = kNothing;  // around all boxes that are in the grid, or have been since all were placed anew
  Lattice lattice_;
  Calendar calendar_;
  std::vector<PairEvent> overlaps_;  // in ascending order of pairs
  Backlog backlog_;                  // what budgets have left over
  bool reclassified_ = false;        // some body, since the last step within a budget
  Step interrupted_at_ = kNeverStep / -2;

  WindowPlan plan_;
  MotionMeans means_;
  double spacing_ = 0, correction_ = 1;
  std::size_t planned_bodies_ = 0;
  unsigned plans_ = 0;
  std::vector<Motion> surveyed_;  // the sample of a survey under way
  BodyIndex survey_next_ = 0;

  Step round_ = 0;            // of looks
  Step prepared_round_ = -1;  // of those done ahead for the next step; -1: none
  Step rush_ = kNeverStep;    // the step at which most windows end
  Step voted_ = kNeverStep;
  std::size_t votes_ = 0;

  // Of the step under way; kept for their memory.
  std::vector<BodyIndex> entries_, due_;
  std::vector<PairEvent> events_, waiting_, tests_;
  std::vector<BodyPair> near_;
  std::vector<Motion> motions_;
  Step last_from_ = -1, last_end_ = 1;
  double last_expiry_ = 0;
};

}  // namespace orchard::runtime::detail
