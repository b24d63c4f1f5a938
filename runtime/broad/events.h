#pragma once
#include "calendar.h"
#include "method.h"
#include "swept_grid.h"
#include "window_plan.h"

namespace orchard::runtime::detail {

// The default method. Each body is looked at once per window of steps: a box around all that its bound allows until the
// window's end goes into a grid, and every other body whose box it meets makes a near pair. A near pair has an event at
// the first step at which the two bounds can touch; no event lies beyond the earlier end of the two windows, as the
// look due there finds the pair anew. Overlapping pairs are tested at every step.
class Events final : public Method {
 public:
  Events(Roster& roster, const BroadPhaseOptions& options) : roster_(roster), options_(options) {}

  void changed(BodyId body) override;
  void removed(BodyId body) override;
  StepReport step(Step now, Meter& meter, std::vector<BodyPair>& pairs) override;
  std::size_t memory_bytes() const noexcept override;

 private:
  enum class Place : std::uint8_t { nowhere, grid, oversized };
  struct Window {
    Step looked = -1;  // events created before are void
    Step end = 0;      // the step of the next look
  };

  void make_room();
  void collect_due(Step now);
  bool crowded(const GridCounts& counts) const noexcept;
  bool worth_a_rebuild() const noexcept;
  void replan(Step now);
  void survey(Step now);
  void place_all_anew();
  void take_away(BodyId body) noexcept;
  void take_away_due() noexcept;

  unsigned look_and_test(Step now, Meter& meter);
  std::size_t look_at(Step now, std::span<const BodyId> bodies, Meter& meter);
  Step window_of(Step now, const Motion& motion) noexcept;
  void place(Step now, std::span<const BodyId> bodies);
  void shrink(Step now, BodyId body, std::size_t i);
  void insert(std::span<const BodyId> bodies);
  void meet_oversized(std::span<const BodyId> bodies);
  bool valid(const PairEvent& event) const noexcept;
  bool test_all(Step now, Meter& meter);
  void settle(Step now, const BodyPair& pair, const Motion& a, const Motion& b);
  void postpone(Step now, std::size_t looked, unsigned from_class);

  Roster& roster_;
  const BroadPhaseOptions options_;

  std::vector<QuantumBox> boxes_;  // by body
  std::vector<Window> windows_;
  std::vector<Place> places_;
  std::vector<std::uint8_t> pending_;  // changed since the last step
  std::vector<BodyId> changed_, oversized_;
  SweptGrid grid_;
  Lattice lattice_;
  Calendar calendar_;
  std::vector<PairEvent> overlaps_;  // in ascending order of pairs; created: the step of the last test

  WindowPlan plan_;
  MotionMeans means_;
  double spacing_ = 0, correction_ = 1;
  std::size_t planned_bodies_ = 0;
  unsigned plans_ = 0;

  // Of the step under way; kept for their memory.
  std::vector<BodyId> entries_, due_;
  std::vector<PairEvent> events_, waiting_, tests_;
  std::vector<BodyPair> near_;
  std::vector<Motion> motions_;
  MotionBlock motion_block_;
  BoxBlock box_block_;
  Step last_now_ = -1, last_window_ = 1;
  double last_expiry_ = 0;
};

}  // namespace orchard::runtime::detail
