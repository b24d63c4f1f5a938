#pragma once
#include "broad_phase/backlog.h"
#include "broad_phase/window_updates.h"

namespace orchard::runtime::detail {

// A step's work within a budget: what it leaves over is resumed at the next step where it stopped.
//
// In each class updates and tests get about the same share of the work, so that neither stands still for the other:
// updates find new pairs, tests report the known ones. Bodies are updated, and pairs tested, in the order in which they
// came to wait, so every one gets its turn. What a window update finds is tested before the class's next update: were
// it to wait among all others, the next update of either body could make it void before its turn comes, again and
// again.
//
// A body that waits keeps its last box in the grid. The box may be wrong, so it proves nothing, but bodies that are
// updated later find it, the pair is tested, and what is reported is what the test says. Without this two bodies
// would have to be within their windows at the same time to be found.
class BudgetedWork {
 public:
  BudgetedWork(KineticState& state, NearPairs& pairs, WindowUpdates& updates)
      : state_(state), pairs_(pairs), updates_(updates) {}

  // What is due waits from now on, behind what has been left over.
  void join(std::span<const BodyIndex> due, std::span<const PairEvent> events);
  void postpone(std::span<const BodyIndex> bodies);
  // Works until all is done, or the budget is spent: then it returns the class under way. kNoClass: all is done.
  unsigned work(Step now, BudgetTracker& tracker);

  void reclassified(BodyIndex body);
  void leave(BodyIndex body) noexcept { backlog_.leave(body); }  // removed, or updated otherwise
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
  bool reclassified_ = false;  // some body, since the last step within a budget
  std::vector<PairEvent> tests_;
  std::vector<BodyPair> unsure_;
};

}  // namespace orchard::runtime::detail
