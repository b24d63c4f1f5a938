#include "events.h"

// A step within a budget: what it leaves over is resumed at the next step where it stopped.
//
// In each class looks and tests get about the same share of the work, so that neither stands still for the other: looks
// find new pairs, tests report the known ones. Bodies are looked at, and pairs tested, in the order in which they came
// to wait, so every one gets its turn. What a look finds is tested before the class's next look: were it to wait among
// all others, the next look at either body could make it void before its turn comes, again and again.
//
// A body that waits keeps its last box in the grid. The box may be wrong, so it proves nothing, but bodies that are
// looked at later find it, the pair is tested, and what is reported is what the test says. Without this two bodies
// would have to be within their windows at the same time to be found.
namespace orchard::runtime::detail {

void Events::postpone(BodyIndex body) {
  windows_[body].end = kLookDue;
  backlog_.wait(body, roster_.importance(body));
}

void Events::reclassified(BodyIndex body) {
  if (backlog_.waits(body)) {
    backlog_.rank(roster_.importance(body));  // nothing throws after that
    backlog_.leave(body);
    backlog_.wait(body, roster_.importance(body));
  }
  reclassified_ = true;
}

// Pairs go to the class that they now belong to.
void Events::sort_pairs_again() {
  reclassified_ = false;
  tests_.clear();
  std::size_t bodies_end = due_.size();
  backlog_.take_all(due_, tests_);
  for (; bodies_end < due_.size(); ++bodies_end) backlog_.wait(due_[bodies_end], roster_.importance(due_[bodies_end]));
  for (const PairEvent& event : tests_) {
    if (valid(event)) backlog_.rank(roster_.importance(event.pair)).due.push(event);
  }
}

// Of what was added in this step, the pairs of which no test has come after the last look at both bodies.
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
    PairQueue& due = backlog_.rank(roster_.importance(pair)).due;
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
  if (outgrown() || rounds_run_out() || roster_.size() > 2 * planned_bodies_) return true;
  return now - interrupted_at_ > kLongestWindow && worth_a_rebuild(due);
}

unsigned Events::step_within(Step now, Meter& meter) {
  const std::size_t due = due_.size();
  join_backlog();
  if (worth_a_rebuild_within(now, due)) {
    if (!replan(now, meter)) return roster_.next_class(0);
    place_all_anew();
    for (const BodyIndex body : due_) postpone(body);
    due_.clear();
    rush_ = kNeverStep;
  }
  make_room_for_boxes();
  for (unsigned rank = roster_.next_class(0); rank < kNoClass; rank = roster_.next_class(rank + 1)) {
    if (!work_through(now, rank, meter)) return rank;
  }
  return kNoClass;
}

// All that waits in a class; false if the budget ends before.
bool Events::work_through(Step now, unsigned importance, Meter& meter) {
  for (;;) {
    Backlog::Rank& rank = backlog_.rank(importance);
    while (!rank.due.empty() && !valid(rank.due.front())) rank.due.pop();
    const bool looking = rank.looking(), testing = !rank.due.empty();
    if (!looking && !testing) {
      rank.lead = 0;
      return true;
    }
    if (meter.spent()) return false;
    if (!looking || !testing) rank.lead = 0;
    // Half of what is left at a time: the other half is for the others.
    const std::size_t left = meter.grant(kWorkPerClock), most = looking && testing ? (left + 1) / 2 : left;
    if (!looking || (testing && rank.lead > 0)) {
      rank.lead -= static_cast<std::int64_t>(test_waiting(now, rank.due, false, most, meter));
    } else if (!rank.found.empty()) {
      rank.lead += static_cast<std::int64_t>(test_waiting(now, rank.found, true, most, meter));
    } else {
      rank.lead += static_cast<std::int64_t>(look_at_waiting(now, importance, most, meter));
    }
  }
}

// Both return the units of work, which are about `most` at most.
std::size_t Events::look_at_waiting(Step now, unsigned importance, std::size_t most, Meter& meter) {
  std::array<BodyIndex, kWorkPerClock> bodies;
  const std::size_t count = backlog_.take(importance, std::span(bodies).first(std::min(most, bodies.size())));
  ++round_;
  for (std::size_t i = 0; i < count; ++i) take_away(bodies[i]);
  near_.clear();
  look_at(now, now, std::span(bodies).first(count), Found::kept);
  meter.count(count);
  for (const BodyPair& pair : near_) {
    const unsigned theirs = roster_.importance(pair);
    Backlog::Rank& rank = backlog_.rank(theirs);
    (theirs == importance ? rank.found : rank.due).push({pair, round_});
    if (theirs != importance) rank.due.tidy([&](const PairEvent& event) { return valid(event); });
  }
  return count;
}

// What has been found is tested even if one of the two has been looked at since.
std::size_t Events::test_waiting(Step now, PairQueue& queue, bool found, std::size_t most, Meter& meter) {
  tests_.clear();
  const std::size_t pairs = std::clamp<std::size_t>(most / 2, 1, kTestsAtOnce);
  while (tests_.size() < pairs && !queue.empty()) {
    const PairEvent event = queue.pop();
    if (!roster_.alive(event.pair.a) || !roster_.alive(event.pair.b)) continue;
    if (!found && !valid(event)) continue;
    overlaps_.drop(event.pair);
    tests_.push_back(event);
  }
  test(now, tests_);
  meter.count(2 * tests_.size());
  return 2 * tests_.size();
}

}  // namespace orchard::runtime::detail
