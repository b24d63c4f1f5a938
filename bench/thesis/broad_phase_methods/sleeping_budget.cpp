#include <algorithm>

#include "sleeping.h"

// A step within a budget. What is limited is the asking, not the search. Bodies whose bounds hold take part, the others
// wait for their turn; of the pairs that touch as far as is known, those are reported whose bodies' motions are of now.
// New bounds and pairs get about the same share of the work, and go round, so every body and every pair gets its turn.
namespace orchard::broad_phase_methods::detail {
namespace {

// Those after the last one come first.
template <typename T>
void rotate_after(std::vector<T>& sorted, const T& last) {
  std::rotate(sorted.begin(), std::upper_bound(sorted.begin(), sorted.end(), last), sorted.end());
}

}  // namespace

void Sleeping::collect_stale(Step now, unsigned importance) {
  stale_.clear();
  for (const BodyIndex body : members_) {
    if (pool_.classes.of(body) == importance && stale(body, now)) stale_.push_back(body);
  }
  rotate_after(stale_, turns_[importance].body);
}

void Sleeping::collect_pairs(Step now, unsigned importance) {
  pairs_.clear();
  for (const BoundContact& contact : found_->initial) {
    const BodyPair pair{present_[contact.a], present_[contact.b]};
    if (contact.time > 0 || pool_.classes.of(pair) != importance) continue;
    if (!current(pair.a, now) || !current(pair.b, now)) pairs_.push_back(pair);
  }
  rotate_after(pairs_, turns_[importance].pair);
}

void Sleeping::ask_in_turn(Step now, Turn& turn, std::uint64_t most, BudgetTracker& tracker) {
  const std::size_t end = static_cast<std::size_t>(std::min<std::uint64_t>(most, stale_.size()));
  for (std::size_t done = 0; done < end && !tracker.spent();) {
    const std::size_t count = tracker.grant(end - done);
    ask(now, std::span(stale_).subspan(done, count));
    tracker.count(count);
    done += count;
    turn.body = stale_[done - 1];
    turn.lead += static_cast<std::int64_t>(count);
  }
}

void Sleeping::test_in_turn(Step now, Turn& turn, std::uint64_t most, BudgetTracker& tracker) {
  std::uint64_t units = 0;
  for (const BodyPair& pair : pairs_) {
    if (units >= most || tracker.spent()) break;
    turn.pair = pair;
    for (const BodyIndex body : {pair.a, pair.b}) {
      if (current(body, now)) continue;
      ask(now, {&body, 1});
      tracker.count(1);
      ++units;
    }
  }
  turn.lead -= static_cast<std::int64_t>(units);
}

// False if the budget ends before.
bool Sleeping::work_through(Step now, unsigned importance, BudgetTracker& tracker) {
  Turn& turn = turns_[importance];
  for (;;) {
    collect_stale(now, importance);
    collect_pairs(now, importance);
    if (stale_.empty() && pairs_.empty()) {
      turn.lead = 0;
      return true;
    }
    if (tracker.spent()) return false;
    const bool both = !stale_.empty() && !pairs_.empty();
    if (!both) turn.lead = 0;
    const std::uint64_t most = both ? tracker.left() / 2 + 1 : tracker.left();
    if (stale_.empty() || (both && turn.lead > 0)) {
      test_in_turn(now, turn, most, tracker);
    } else {
      ask_in_turn(now, turn, most, tracker);
    }
    find(now);
  }
}

std::size_t Sleeping::left_over(Step now) const noexcept {
  std::size_t count = 0;
  for (const BodyIndex body : members_) count += stale(body, now);
  for (const BoundContact& contact : found_->initial) {
    count += contact.time <= 0 && (!current(present_[contact.a], now) || !current(present_[contact.b], now));
  }
  return count;
}

StepReport Sleeping::step_within(Step now, BudgetTracker& tracker) {
  if (turns_.empty()) turns_.resize(kNoClass);
  find(now);
  for (unsigned rank = pool_.classes.next(0); rank < kNoClass; rank = pool_.classes.next(rank + 1)) {
    if (work_through(now, rank, tracker)) continue;
    report(now);
    return {now + 1, reported_, rank, left_over(now)};
  }
  report(now);
  return sleep(now);
}

}  // namespace orchard::broad_phase_methods::detail
