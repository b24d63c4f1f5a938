#include "broad_phase/budgeted_work.h"

namespace orchard::runtime::detail {

void BudgetedWork::postpone(std::span<const BodyIndex> bodies) {
  for (const BodyIndex body : bodies) {
    state_.windows[body].end = kUpdateDue;
    backlog_.wait(body, state_.pool.classes.of(body));
  }
}

void BudgetedWork::reclassified(BodyIndex body) {
  if (backlog_.waits(body)) {
    backlog_.rank(state_.pool.classes.of(body));  // nothing throws after that
    backlog_.leave(body);
    backlog_.wait(body, state_.pool.classes.of(body));
  }
  reclassified_ = true;
}

// Moves bodies and pairs to the classes that they now belong to.
void BudgetedWork::sort_pairs_again() {
  reclassified_ = false;
  tests_.clear();
  std::vector<BodyIndex> bodies;
  backlog_.take_all(bodies, tests_);
  for (const BodyIndex body : bodies) backlog_.wait(body, state_.pool.classes.of(body));
  for (const PairEvent& event : tests_) {
    if (state_.windows.valid(event)) backlog_.rank(state_.pool.classes.of(event.pair)).due.push(event);
  }
}

void BudgetedWork::join(std::span<const BodyIndex> due, std::span<const PairEvent> events) {
  if (reclassified_ && !backlog_.empty()) sort_pairs_again();
  reclassified_ = false;
  postpone(due);
  const auto test_later = [&](const BodyPair& pair, Round created) {
    WorkQueue<PairEvent>& queue = backlog_.rank(state_.pool.classes.of(pair)).due;
    queue.push({pair, created});
    queue.tidy([&](const PairEvent& old) { return state_.windows.valid(old); });
  };
  for (const PairEvent& event : events) {
    if (!state_.windows.valid(event)) continue;
    state_.overlaps.drop(event.pair);  // the pair leaves the list unless it is tested at this step
    test_later(event.pair, event.created);
  }
  if (backlog_.no_body_waits()) return;
  // The bounds of bodies that wait may not hold any more, so it is not known whether their pairs still overlap. These
  // pairs leave the list and wait for a test.
  unsure_.clear();
  state_.overlaps.take_out([&](const BodyPair& pair) { return backlog_.waits(pair.a) || backlog_.waits(pair.b); },
                           unsure_);
  for (const BodyPair& pair : unsure_) {
    const PairEvent event{pair, state_.windows.round()};
    if (state_.windows.valid(event)) test_later(pair, state_.windows.round());
  }
}

unsigned BudgetedWork::work(Step now, BudgetTracker& tracker) {
  for (unsigned rank = state_.pool.classes.next(0); rank < kNoClass; rank = state_.pool.classes.next(rank + 1)) {
    if (!work_through(now, rank, tracker)) return rank;
  }
  return kNoClass;
}

// Does all work that waits in a class. Returns false if the budget ends before that.
bool BudgetedWork::work_through(Step now, unsigned importance, BudgetTracker& tracker) {
  for (;;) {
    Backlog::Rank& rank = backlog_.rank(importance);
    while (!rank.due.empty() && !state_.windows.valid(rank.due.front())) rank.due.pop();
    const bool updating = rank.updating(), testing = !rank.due.empty();
    if (!updating && !testing) {
      rank.lead = 0;
      return true;
    }
    if (tracker.spent()) return false;
    if (!updating || !testing) rank.lead = 0;
    // Each kind of work gets half of what is left at a time, so that the other half remains for the other kind.
    const std::size_t left = tracker.grant(kWorkPerClock), most = updating && testing ? (left + 1) / 2 : left;
    if (!updating || (testing && rank.lead > 0)) {
      rank.lead -= static_cast<std::int64_t>(test_waiting(now, rank.due, false, most, tracker));
    } else if (!rank.found.empty()) {
      rank.lead += static_cast<std::int64_t>(test_waiting(now, rank.found, true, most, tracker));
    } else {
      rank.lead += static_cast<std::int64_t>(update_waiting(now, importance, most, tracker));
    }
  }
}

// This function and the next one return the units of work that they have done, which are at most about `most`.
std::size_t BudgetedWork::update_waiting(Step now, unsigned importance, std::size_t most, BudgetTracker& tracker) {
  std::array<BodyIndex, kWorkPerClock> bodies;
  const std::size_t count = backlog_.take(importance, std::span(bodies).first(std::min(most, bodies.size())));
  const auto updated = std::span(bodies).first(count);
  state_.windows.begin_round();
  for (const BodyIndex body : updated) state_.boxes.take_away(body);
  const std::span<const BodyPair> near = updates_.find_near(now, updated);
  tracker.count(count);
  for (const BodyPair& pair : near) {
    const unsigned theirs = state_.pool.classes.of(pair);
    Backlog::Rank& rank = backlog_.rank(theirs);
    (theirs == importance ? rank.found : rank.due).push({pair, state_.windows.round()});
    if (theirs != importance) rank.due.tidy([&](const PairEvent& event) { return state_.windows.valid(event); });
  }
  return count;
}

// Pairs that an update has found (`found`) are tested even if one of their bodies has been updated since.
std::size_t BudgetedWork::test_waiting(Step now, WorkQueue<PairEvent>& queue, bool found, std::size_t most,
                                       BudgetTracker& tracker) {
  tests_.clear();
  const std::size_t pairs = std::clamp<std::size_t>(most / 2, 1, NearPairs::kTestsAtOnce);
  while (tests_.size() < pairs && !queue.empty()) {
    const PairEvent event = queue.pop();
    if (!state_.pool.alive(event.pair.a) || !state_.pool.alive(event.pair.b)) continue;
    if (!found && !state_.windows.valid(event)) continue;
    state_.overlaps.drop(event.pair);
    tests_.push_back(event);
  }
  pairs_.test(now, tests_);
  tracker.count(2 * tests_.size());
  return 2 * tests_.size();
}

}  // namespace orchard::runtime::detail
