#include "detector/report_events.h"

#include <algorithm>

namespace orchard::runtime::detail {
namespace {

BodyPair bodies_of(const PairEvent& event) noexcept { return {event.a.index, event.b.index}; }

// Resets the answer to what holds if nothing is known of the pair at this step.
void forget_step(CachedPair& pair) noexcept {
  pair.verdict = unknown_verdict();
  pair.sweep.impact = false;
  pair.answered = -1;
}

}  // namespace

PairEvent EventReporter::describe(const CachedPair& pair, Step step, PairChange change) const noexcept {
  const Clock& clock = world_.clock;
  PairEvent event{change, pair.a, pair.b, pair.parts[0], pair.parts[1], clock.time(step), pair.verdict};
  if (!pair.sweep.impact) return event;
  event.impact_from = event.time + (pair.sweep.impact_from - 1) * clock.time_step;
  event.impact_to = event.time + (pair.sweep.impact_to - 1) * clock.time_step;
  return event;
}

bool EventReporter::part(CachedPair& pair, bool there, bool jumped, Step step) {
  forget_step(pair);
  if (there) pair.verdict.answer = Answer::no;
  const bool stays = there && !jumped && pair.touching && ++pair.separated_steps < world_.options.steps_to_end;
  if (pair.touching) ended_.push_back(describe(pair, step, stays ? PairChange::stay : PairChange::end));
  return stays;
}

void EventReporter::end_by_teleport(CachedPair& pair, Step step) {
  forget_step(pair);
  ended_.push_back(describe(pair, step, PairChange::end));
  pair.touching = false;
}

// Updates whether the pair touches, according to its answer at this step, and returns the event that follows, if any.
EventReporter::Outcome EventReporter::begin_or_end(CachedPair& pair) const noexcept {
  const Answer answer = pair.verdict.answer;
  if (!pair.versions.allowed) {
    if (!pair.touching) return std::nullopt;
    pair.touching = pair.sweep.impact = false;
    pair.verdict = Verdict{};
    pair.answered = -1;
    return PairChange::end;
  }
  pair.turn.waited = answer == Answer::maybe ? pair.turn.waited + 1 : 0;
  if (answer == Answer::yes) {
    pair.separated_steps = 0;
    return std::exchange(pair.touching, true) ? PairChange::stay : PairChange::begin;
  }
  if (!pair.touching) return answer == Answer::maybe ? Outcome(PairChange::possible) : std::nullopt;
  pair.separated_steps = answer == Answer::no ? pair.separated_steps + 1 : 0;
  if (pair.separated_steps < world_.options.steps_to_end) return PairChange::stay;
  pair.touching = false, pair.separated_steps = 0;
  return PairChange::end;
}

void EventReporter::conclude(const ActivePairs& active, std::size_t i) noexcept {
  CachedPair& pair = active.cached(i);
  outcomes_[i] = begin_or_end(pair);
  active.tell(i, pair.touching || pair.turn.waited > 0);
  if (pair.versions.allowed) skipper_.keep_clearance(active.known(i), pair);
  pair.apart_along = {};
}

// Every pair without a certain answer has an event, so Frame::certain can be counted from the events.
void EventReporter::report(const ActivePairs& active, Step step, Frame& frame) {
  const auto by_bodies = [](const PairEvent& p, const PairEvent& q) { return bodies_of(p) < bodies_of(q); };
  // The ends by teleports were added after all others.
  if (!std::is_sorted(ended_.begin(), ended_.end(), by_bodies)) std::sort(ended_.begin(), ended_.end(), by_bodies);
  auto ended = ended_.begin();
  frame.certain += active.size();
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (!outcomes_[i]) continue;
    active.prefetch(i);
    for (; ended != ended_.end() && !(active.pair(i) < bodies_of(*ended)); ++ended) append(events_, *ended);
    const CachedPair& pair = active.cached(i);
    append(events_, describe(pair, step, *outcomes_[i]));
    if (pair.verdict.answer != Answer::maybe || outcomes_[i] == PairChange::end) continue;
    --frame.certain;
    frame.worst_bound = std::max(frame.worst_bound, pair.verdict.separation_bound);
  }
  for (; ended != ended_.end(); ++ended) append(events_, *ended);
  ended_.clear();
}

}  // namespace orchard::runtime::detail
