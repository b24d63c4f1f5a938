#pragma once
#include "broad_phase/backlog.h"
#include "broad_phase/window_updates.h"

namespace orchard::runtime::detail {

// The work of steps within a budget. What a step leaves over, the next one resumes.
//
// In each class of importance, window updates, which find new pairs, and tests, which report known ones, each get about
// half of the work, so that neither has to wait for the other. Bodies are updated, and pairs are tested, in the order
// in which they came to wait, so each of them gets its turn. The pairs that a window update finds are tested before the
// next update of the class. If they waited behind all others, the next update of one of the bodies could make them void
// before their turn came, again and again.
//
// A body that waits keeps its last box in the grid. The box may be wrong, so it proves nothing. But bodies that are
// updated later find it, the pair is tested, and the test decides what is reported. Otherwise, two bodies would be
// found only if both were within their windows at the same time.
class BudgetedWork {
 public:
  BudgetedWork(KineticState& state, NearPairs& pairs, WindowUpdates& updates)
      : state_(state), pairs_(pairs), updates_(updates) {}

  // Lets the bodies and pairs that are due wait behind those that were left over.
  void join(std::span<const BodyIndex> due, std::span<const PairEvent> events);
  void postpone(std::span<const BodyIndex> bodies);  // lets them wait for an update
  // Works until all is done or the budget is spent. Returns kNoClass if all is done; otherwise, the class that is not.
  unsigned work(Step now, BudgetTracker& tracker);

  void reclassified(BodyIndex body);
  void leave(BodyIndex body) noexcept { backlog_.leave(body); }  // the body was removed, or updated elsewhere
  void take_all(std::vector<BodyIndex>& bodies, std::vector<PairEvent>& pairs) { backlog_.take_all(bodies, pairs); }
  bool nothing_left() const noexcept { return backlog_.empty(); }
  std::size_t left_over() const noexcept { return std::max<std::size_t>(1, backlog_.size()); }
  void append_bodies(std::vector<BodyIndex>& bodies) const { backlog_.append_bodies(bodies); }
  std::size_t memory_bytes() const noexcept { return backlog_.memory_bytes() + bytes_of(tests_, unsure_); }

 private:
  void sort_pairs_again();
  bool work_through(Step now, unsigned importance, BudgetTracker& tracker);
  std::size_t update_waiting(Step now, unsigned importance, std::size_t most, BudgetTracker& tracker);
  std::size_t test_waiting(Step now, WorkQueue<PairEvent>& queue, bool found, std::size_t most, BudgetTracker& tracker);

  KineticState& state_;
  NearPairs& pairs_;
  WindowUpdates& updates_;
  Backlog backlog_;
  bool reclassified_ = false;  // a body has another class since the last step within a budget
  std::vector<PairEvent> tests_;
  std::vector<BodyPair> unsure_;
};

}  // namespace orchard::runtime::detail
