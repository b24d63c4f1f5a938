#include "events.h"

// A step within a budget: what it leaves over is resumed at the next step where it stopped.
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
namespace orchard::runtime::detail {

void Events::postpone(BodyIndex body) {
  windows_[body].end = kUpdateDue;
  backlog_.wait(body, pool_.importance(body));
}

void Events::reclassified(BodyIndex body) {
  if (backlog_.waits(body)) {
    backlog_.rank(pool_.importance(body));  // nothing throws after that
    backlog_.leave(body);
    backlog_.wait(body, pool_.importance(body));
  }
  reclassified_ = true;
}

// Pairs go to the class that they now belong to.
void Events::sort_pairs_again() {
  reclassified_ = false;
  tests_.clear();
  std::size_t bodies_end = due_.size();
  backlog_.take_all(due_, tests_);
  for (; bodies_end < due_.size(); ++bodies_end) backlog_.wait(due_[bodies_end], pool_.importance(due_[bodies_end]));
  for (const PairEvent& event : tests_) {
    if (valid(event)) backlog_.rank(pool_.importance(event.pair)).due.push(event);
  }
}

// Of what was added in this step, the pairs of which no test has come after the last update of both bodies.
void Events::keep_doubtful() {
  near_.clear();
  for (const PairEvent& event : doubtful_) {
    if (valid(event)) near_.push_back(event.pair);
  }
  std::sort(near_.begin(), near_.end());
  std::erase_if(doubtful_,
                [&](const PairEvent& event) { return std::binary_search(near_.begin(), near_.end(), event.pair); });
  near_.clear();
}

void Events::join_backlog() {
  if (reclassified_ && !backlog_.empty()) sort_pairs_again();
  reclassified_ = false;
  for (const BodyIndex body : due_) postpone(body);
  due_.clear();
  const auto test_later = [&](const BodyPair& pair, Round created) {
    PairQueue& due = backlog_.rank(pool_.importance(pair)).due;
    due.push({pair, created});
    due.tidy([&](const PairEvent& old) { return valid(old); });
  };
  for (const PairEvent& event : waiting_) {
    if (!valid(event)) continue;
    overlaps_.drop(event.pair);  // unless it is tested at this step
    test_later(event.pair, event.created);
  }
  if (backlog_.no_body_waits()) return;
  // No bound says any more that these overlap still.
  near_.clear();
  overlaps_.take_out([&](const BodyPair& pair) { return backlog_.waits(pair.a) || backlog_.waits(pair.b); }, near_);
  for (const BodyPair& pair : near_) {
    const PairEvent event{pair, round_};
    if (valid(event)) test_later(pair, round_);
  }
  near_.clear();
}

// A rebuild forgets all boxes. It has to be where there are many more bodies than planned for; where it is a matter of
// speed, only if no budget has interrupted for as long as a window lasts: else nothing would ever be finished.
bool Events::worth_a_rebuild_within(Step now, std::size_t due) const noexcept {
  if (sorting_ || outgrown() || rounds_run_out() || pool_.size() > 2 * planned_bodies_) return true;
  return now - interrupted_at_ > kLongestWindow && worth_a_rebuild(due);
}

unsigned Events::step_within(Step now, BudgetTracker& tracker) {
  const std::size_t due = due_.size();
  join_backlog();
  if (worth_a_rebuild_within(now, due)) {
    if (!replan(now, tracker)) return pool_.next_class(0);
    place_all_anew();
    for (const BodyIndex body : due_) postpone(body);
    due_.clear();
    common_expiry_ = kNeverStep;
  }
  make_room_for_boxes();
  for (unsigned rank = pool_.next_class(0); rank < kNoClass; rank = pool_.next_class(rank + 1)) {
    if (!work_through(now, rank, tracker)) return rank;
  }
  return kNoClass;
}

// All that waits in a class; false if the budget ends before.
bool Events::work_through(Step now, unsigned importance, BudgetTracker& tracker) {
  for (;;) {
    Backlog::Rank& rank = backlog_.rank(importance);
    while (!rank.due.empty() && !valid(rank.due.front())) rank.due.pop();
    const bool updating = rank.updating(), testing = !rank.due.empty();
    if (!updating && !testing) {
      rank.lead = 0;
      return true;
    }
    if (tracker.spent()) return false;
    if (!updating || !testing) rank.lead = 0;
    // Half of what is left at a time: the other half is for the others.
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

// Both return the units of work, which are about `most` at most.
std::size_t Events::update_waiting(Step now, unsigned importance, std::size_t most, BudgetTracker& tracker) {
  std::array<BodyIndex, kWorkPerClock> bodies;
  const std::size_t count = backlog_.take(importance, std::span(bodies).first(std::min(most, bodies.size())));
  ++round_;
  for (std::size_t i = 0; i < count; ++i) take_away(bodies[i]);
  near_.clear();
  update_windows(now, now, std::span(bodies).first(count), Found::kept);
  tracker.count(count);
  for (const BodyPair& pair : near_) {
    const unsigned theirs = pool_.importance(pair);
    Backlog::Rank& rank = backlog_.rank(theirs);
    (theirs == importance ? rank.found : rank.due).push({pair, round_});
    if (theirs != importance) rank.due.tidy([&](const PairEvent& event) { return valid(event); });
  }
  return count;
}

// What has been found is tested even if one of the two has been updated since.
std::size_t Events::test_waiting(Step now, PairQueue& queue, bool found, std::size_t most, BudgetTracker& tracker) {
  tests_.clear();
  const std::size_t pairs = std::clamp<std::size_t>(most / 2, 1, kTestsAtOnce);
  while (tests_.size() < pairs && !queue.empty()) {
    const PairEvent event = queue.pop();
    if (!pool_.alive(event.pair.a) || !pool_.alive(event.pair.b)) continue;
    if (!found && !valid(event)) continue;
    overlaps_.drop(event.pair);
    tests_.push_back(event);
  }
  test(now, tests_);
  tracker.count(2 * tests_.size());
  return 2 * tests_.size();
}

}  // namespace orchard::runtime::detail
