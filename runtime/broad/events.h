#pragma once
#include "box_list.h"
#include "calendar.h"
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
  void removed(BodyIndex body) override;
  StepReport step(Step now, Meter& meter, std::vector<BodyPair>& pairs) override;
  std::size_t memory_bytes() const noexcept override;

 private:
  enum class Place : std::uint8_t { nowhere, inside, oversized };
  struct Window {
    Step looked = -1;  // the round of the last look: events of earlier rounds are void
    Step end = 0;      // the step of the next look
  };
  struct Look;
  static constexpr std::size_t kFewestInRush = 32;  // bodies that are worth a step more

  // events.cpp: a step
  void make_room();
  void forget_all() noexcept;
  void collect_due(Step now);
  void complete_due();
  void take_away(BodyIndex body) noexcept;
  void take_away_due() noexcept;
  unsigned look_and_test(Step now, Meter& meter);
  void postpone(Step now, std::size_t looked, unsigned from_class);

  // events_plan.cpp: looks at all bodies
  bool crowded(const GridCounts& counts) const noexcept;
  bool worth_a_rebuild() const noexcept;
  void replan(Step now);
  void survey(Step now);
  void place_all_anew();
  bool prepare(Step now);
  void vote(Step end, std::size_t bodies) noexcept;

  // events_look.cpp: a look at some
  std::size_t look_at(Step now, Step from, std::span<const BodyIndex> bodies, Meter& meter);
  std::size_t known_at(Step from, std::span<BodyIndex> bodies) noexcept;
  Step window_end(Step from, const Motion& motion) noexcept;
  void place(Look& look, std::span<const BodyIndex> bodies);
  void shrink(Look& look, BodyIndex body, std::size_t i);
  void insert(Look& look, std::span<const BodyIndex> bodies);
  void meet_oversized(std::span<const BodyIndex> bodies);

  // events_pairs.cpp
  bool valid(const PairEvent& event) const noexcept;
  bool test_all(Step now, Meter& meter);
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
  Lattice lattice_;
  Calendar calendar_;
  std::vector<PairEvent> overlaps_;  // in ascending order of pairs

  WindowPlan plan_;
  MotionMeans means_;
  double spacing_ = 0, correction_ = 1;
  std::size_t planned_bodies_ = 0;
  unsigned plans_ = 0;

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
