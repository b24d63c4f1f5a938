#include "detector/report_events.h"

#include <algorithm>

namespace orchard::runtime::detail {
namespace {

BodyPair bodies_of(const PairEvent& event) noexcept { return {event.a.index, event.b.index}; }

// Of a pair that nothing is known of at this step.
Verdict nothing_known(Answer answer) noexcept {
  Verdict verdict;
  verdict.answer = answer;
  verdict.separation_bound = std::numeric_limits<double>::infinity();
  return verdict;
}

}  // namespace

void EventReporter::describe(const CachedPair& pair, Step step, PairChange change, PairEvent& event) const noexcept {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const Clock& clock = world_.clock;
  event.change = change;
  event.a = pair.a, event.b = pair.b;
  event.part_a = pair.parts[0], event.part_b = pair.parts[1];
  event.time = clock.time(step);
  event.verdict = pair.verdict;
  const auto at = [&](double share) { return clock.time(step) + (share - 1) * clock.time_step; };
  event.impact_from = pair.sweep.impact ? at(pair.sweep.impact_from) : kNone;
  event.impact_to = pair.sweep.impact ? at(pair.sweep.impact_to) : kNone;
}

bool EventReporter::part(CachedPair& pair, bool there, bool jumped, Step step) {
  pair.sweep.impact = false;
  pair.answered = -1;
  pair.verdict = nothing_known(there ? Answer::no : Answer::maybe);
  if (there && !jumped && pair.touching && ++pair.separated_steps < world_.options.steps_to_end) {
    describe(pair, step, PairChange::stay, ended_.emplace_back());
    return true;
  }
  if (pair.touching) describe(pair, step, PairChange::end, ended_.emplace_back());
  return false;
}

void EventReporter::end_by_teleport(CachedPair& pair, Step step) {
  pair.verdict = nothing_known(Answer::maybe);
  pair.sweep.impact = false;
  describe(pair, step, PairChange::end, ended_.emplace_back());
  pair.touching = false;
}

void EventReporter::begin_jobs(const ActivePairs& active, std::size_t jobs) {
  grow(outcomes_, active.size());
  job_count_ = jobs;
  grow(tallies_, job_count_);
}

// What the answer makes of the pair, and which event that is.
EventReporter::Outcome EventReporter::begin_or_end(CachedPair& pair) const noexcept {
  const Answer answer = pair.verdict.answer;
  if (!pair.versions.allowed) {
    if (!pair.touching) return Outcome::nothing;
    pair.touching = pair.sweep.impact = false;
    pair.verdict = Verdict{};
    pair.answered = -1;
    return Outcome::end;
  }
  pair.turn.waited = answer == Answer::maybe ? pair.turn.waited + 1 : 0;
  if (answer == Answer::yes) {
    pair.separated_steps = 0;
    const bool before = pair.touching;
    pair.touching = true;
    return before ? Outcome::stay : Outcome::begin;
  }
  if (!pair.touching) return answer == Answer::maybe ? Outcome::possible : Outcome::nothing;
  pair.separated_steps = answer == Answer::no ? pair.separated_steps + 1 : 0;
  if (pair.separated_steps < world_.options.steps_to_end) return Outcome::stay;
  pair.touching = false, pair.separated_steps = 0;
  return Outcome::end;
}

// What the answer, or that none was asked for, makes of an active pair.
void EventReporter::conclude(const ActivePairs& active, std::size_t i, Tally& tally) noexcept {
  CachedPair& pair = active.cached(i);
  // Of what is not allowed it is certain that nothing is asked.
  const bool maybe = pair.versions.allowed && pair.verdict.answer == Answer::maybe;
  tally.certain += !maybe;
  if (maybe) tally.worst_bound = std::max(tally.worst_bound, pair.verdict.separation_bound);
  outcomes_[i] = begin_or_end(pair);
  tally.events += outcomes_[i] != Outcome::nothing;
  active.tell(i, pair.touching || pair.turn.waited > 0);
  if (pair.versions.allowed) skipper_.keep_clearance(active.known(i), pair);
  pair.apart.along = {};
}

void EventReporter::conclude_all(const ActivePairs& active) {
  constexpr std::size_t kPerJob = 512;
  begin_jobs(active, std::max<std::size_t>(1, (active.size() + kPerJob - 1) / kPerJob));
  auto conclude_some = [&](std::size_t job) {
    Tally& tally = tallies_[job];
    tally = {};
    const std::size_t end = first_of_job(active, job + 1);
    for (std::size_t i = first_of_job(active, job); i < end; ++i) {
      active.prefetch(i, end);
      conclude(active, i, tally);
    }
  };
  run_jobs(world_.options.executor, job_count_, conclude_some);
}

// Where each job's events go, those that have ended among its pairs included.
void EventReporter::place_events(const ActivePairs& active, Frame& frame) {
  std::size_t written = event_count_;
  for (std::size_t job = 0; job < job_count_; ++job) {
    Tally& of = tallies_[job];
    frame.certain += of.certain;
    frame.worst_bound = std::max(frame.worst_bound, of.worst_bound);
    of.events_from = written;
    if (job > 0) {
      const BodyPair first = active.pair(first_of_job(active, job));
      const auto from = std::partition_point(ended_.begin(), ended_.end(),
                                             [&](const PairEvent& event) { return bodies_of(event) < first; });
      of.ended_from = static_cast<std::size_t>(from - ended_.begin());
      of.events_from += of.ended_from - tallies_[job - 1].ended_from;
    }
    written = of.events_from + of.events;
  }
  event_count_ = written + ended_.size() - tallies_[job_count_ - 1].ended_from;
  grow(events_, event_count_);
}

void EventReporter::write_events(const ActivePairs& active, std::size_t job, Step step) noexcept {
  const std::size_t end = first_of_job(active, job + 1);
  const std::size_t ended_to = job + 1 < job_count_ ? tallies_[job + 1].ended_from : ended_.size();
  std::size_t next = tallies_[job].ended_from, to = tallies_[job].events_from;
  for (std::size_t i = first_of_job(active, job); i < end; ++i) {
    active.prefetch(i, end);
    const auto& known = active.known(i);
    for (; next < ended_to && !(known.pair < bodies_of(ended_[next])); ++next) events_[to++] = ended_[next];
    if (outcomes_[i] == Outcome::nothing) continue;
    describe(active.cached(i), step, static_cast<PairChange>(outcomes_[i]), events_[to++]);
  }
  for (; next < ended_to; ++next) events_[to++] = ended_[next];
}

void EventReporter::report(const ActivePairs& active, Step step, Frame& frame) {
  const auto by_bodies = [](const PairEvent& p, const PairEvent& q) { return bodies_of(p) < bodies_of(q); };
  // Teleports come after all others.
  if (!std::is_sorted(ended_.begin(), ended_.end(), by_bodies)) std::sort(ended_.begin(), ended_.end(), by_bodies);
  place_events(active, frame);
  auto write_some = [&](std::size_t job) { write_events(active, job, step); };
  run_jobs(world_.options.executor, job_count_, write_some);
  ended_.clear();
}

}  // namespace orchard::runtime::detail
