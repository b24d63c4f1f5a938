#include <algorithm>

#include "detector/detector_state.h"

// Which records have to be asked about, and from answers to events: by jobs, since most of it is waiting for memory.
namespace orchard::runtime {

using detail::Body;
using detail::is_half_space;
using detail::Record;

namespace {

constexpr std::size_t kPerJob = 512;  // records

}  // namespace

// For a loop over `active`: what the next ones need is on its way from memory.
ORCHARD_INLINE void Detector::State::prefetch_active(std::size_t i, std::size_t end) const noexcept {
  constexpr std::size_t kKnown = 12, kRecord = 8, kBodies = 6;  // places ahead
  if (i + kKnown < end) records.prefetch_known(active[i + kKnown]);
  if (i + kRecord < end) detail::prefetch_all(records[records.known(active[i + kRecord]).record]);
  if (i + kBodies < end) places.prefetch_bodies(records.pair(active[i + kBodies]));
}

void Detector::State::describe(const Record& record, Step step, PairChange change, PairEvent& event) const noexcept {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  event.change = change;
  event.a = record.a, event.b = record.b;
  event.part_a = record.part_a, event.part_b = record.part_b;
  event.time = clock.time(step);
  event.verdict = record.verdict;
  const auto at = [&](double share) { return clock.time(step) + (share - 1) * clock.time_step; };
  event.impact_from = record.impact ? at(record.impact_from) : kNone;
  event.impact_to = record.impact ? at(record.impact_to) : kNone;
}

// Neither has moved since the last certain answer.
bool Detector::State::reusable(const Record& record) const noexcept {
  const Body &a = places.body(record.pair.a), &b = places.body(record.pair.b);
  return record.answered >= 0 && std::max(a.moved, b.moved) <= record.answered && !record.impact;
}

// Whether it has to be asked about. Changes nothing else; a touch of what has been teleported is over.
bool Detector::State::opens(Record& record, Step step, bool& over) noexcept {
  const Body &a = places.body(record.pair.a), &b = places.body(record.pair.b);
  record.importance = std::max(a.importance, b.importance);
  if (!record.allowed) return false;
  const bool continuous = a.continuous_speed > 0 || b.continuous_speed > 0;
  const std::uint32_t jumps = a.jumps + b.jumps;
  const auto known_before = [&](const Body& body) {
    return body.is_static || (body.frozen && body.asked < step) || body.known_before == step - 1;
  };
  record.swept = continuous && record.jumps == jumps && known_before(a) && known_before(b);
  // As spheres reach as far as a step leads, who was not asked for at the step before had nothing near then: unless
  // the broad phase could not tell, or its parts go farther now. Nothing was between it and a body that is new.
  const bool sphere_fell_short = interrupted || a.stretched == step - 1 || b.stretched == step - 1;
  const bool both_before = std::max(a.since, b.since) < step;
  record.unseen = continuous && record.jumps == jumps && !record.swept && sphere_fell_short && both_before;
  over = record.jumps != jumps && record.touching;
  if (over) record.answered = -1;
  record.jumps = jumps;
  if (record.deformed != a.deformed + b.deformed) {
    record.deformed = a.deformed + b.deformed;
    record.trees.forget();
  }
  return !reusable(record);
}

// The application's own filter belongs to this thread.
void Detector::State::ask_filter() {
  for (std::size_t i = 0; filter && i < active_count; ++i) allowed(record_of(records.known(active[i])));
}

void Detector::State::open_records(Step step) {
  open.clear();
  detail::grow(marks, active_count);
  enum : std::uint8_t { kOpens = 1, kOver = 2, kLarge = 4 };  // kLarge: and begun now
  ask_filter();
  auto look_at_some = [&](std::size_t job) {
    const std::size_t end = std::min(active_count, (job + 1) * kPerJob);
    for (std::size_t i = job * kPerJob; i < end; ++i) {
      prefetch_active(i, end);
      auto& known = records.known(active[i]);
      const bool begins = !records.is_begun(known);
      Record& record = record_of(known);
      allowed(record);
      bool over = false;
      const bool asked = opens(record, step, over);
      marks[i] =
          static_cast<std::uint8_t>((asked ? kOpens : 0) | (over ? kOver : 0) | (begins && record.large ? kLarge : 0));
    }
  };
  run_jobs(options.executor, (active_count + kPerJob - 1) / kPerJob, look_at_some);
  for (std::size_t i = 0; i < active_count; ++i) {
    const std::uint32_t index = records.known(active[i]).record;
    if ((marks[i] & kOver) != 0) {
      Record& record = records[index];
      record.verdict = Verdict{};
      record.verdict.separation_bound = std::numeric_limits<double>::infinity();
      record.impact = false;
      describe(record, step, PairChange::end, ended.emplace_back());
      record.touching = false;
    }
    if ((marks[i] & kOpens) != 0) open.push_back(index);
    large_pairs += (marks[i] & kLarge) != 0;
  }
  fronts.prepare(large_pairs);
}

// After a certain "no". What is swept is asked at each step.
void Detector::State::keep_clearance(detail::RecordTable::Known& known, const Record& record) const noexcept {
  const Body &a = places.body(record.pair.a), &b = places.body(record.pair.b);
  const bool lasts = record.verdict.answer == Answer::no && !record.touching && !(a.continuous_speed > 0) &&
                     !(b.continuous_speed > 0) && a.valid && b.valid && std::isfinite(record.verdict.lower_bound);
  if (!lasts) return;
  const detail::Standing now = standing(known.pair);
  const double way = detail::length(now.way);
  double distance = record.verdict.lower_bound - now.slack - detail::kRoundedToFloat * way;
  detail::Clearance& kept = known.clearance;
  const auto rounded = [](const Vec3& v) -> detail::Clearance::Floats {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  };
  kept.along = {};
  const double reach = is_half_space(known.pair.b)
                           ? std::numeric_limits<double>::infinity()
                           : bodies.whereabouts(known.pair.a).reach + bodies.whereabouts(known.pair.b).reach;
  if (dot(record.along, record.along) > 0 && std::isfinite(reach)) {
    kept.along = rounded(record.along);
    distance -= detail::kRoundedToFloat * (way + reach);  // no two of their points are farther from each other
  }
  kept.distance = distance > 0 ? distance : 0;
  kept.way = rounded(now.way);
  kept.turned = now.turned, kept.changes = now.changes;
}

// What the answer makes of the pair, and which event that is.
Detector::State::Outcome Detector::State::begin_or_end(Record& record) const noexcept {
  const Answer answer = record.verdict.answer;
  if (!record.allowed) {
    if (!record.touching) return Outcome::nothing;
    record.touching = record.impact = false;
    record.verdict = Verdict{};
    record.answered = -1;
    return Outcome::end;
  }
  record.waited = answer == Answer::maybe ? record.waited + 1 : 0;
  if (answer == Answer::yes) {
    record.nos = 0;
    const bool before = record.touching;
    record.touching = true;
    return before ? Outcome::stay : Outcome::begin;
  }
  if (!record.touching) return answer == Answer::maybe ? Outcome::possible : Outcome::nothing;
  record.nos = answer == Answer::no ? record.nos + 1 : 0;
  if (record.nos < options.steps_to_end) return Outcome::stay;
  record.touching = false, record.nos = 0;
  return Outcome::end;
}

// What the answer, or that none was asked for, makes of active[i].
void Detector::State::conclude(std::size_t i, Record& record, Tally& tally) noexcept {
  // Of what is not allowed it is certain that nothing is asked.
  const bool maybe = record.allowed && record.verdict.answer == Answer::maybe;
  tally.certain += !maybe;
  if (maybe) tally.worst_bound = std::max(tally.worst_bound, record.verdict.separation_bound);
  const Outcome outcome = begin_or_end(record);
  marks[i] = static_cast<std::uint8_t>(outcome);
  tally.events += outcome != Outcome::nothing;
  const bool busy = record.touching || record.waited > 0;
  records.tell(active[i], busy, busy || record.large);
  if (record.allowed) keep_clearance(records.known(active[i]), record);
  record.along = {};
}

void Detector::State::tally(std::size_t job, Tally& tally) noexcept {
  tally = {};
  const std::size_t end = first_of_job(job + 1);
  for (std::size_t i = first_of_job(job); i < end; ++i) {
    prefetch_active(i, end);
    conclude(i, records[records.known(active[i]).record], tally);
  }
}

// Where nothing has to wait for all answers: records are opened, answered and concluded one after the other.
std::uint64_t Detector::State::answer_one_by_one(Step step) {
  detail::grow(marks, active_count);
  job_count = rounds.jobs(active_count);
  detail::grow(tallies, job_count);
  ask_filter();
  const std::uint64_t work = rounds.answer_by(job_count, [&](std::size_t job, detail::QueryPool::Scratch& scratch) {
    Tally& tally = tallies[job];
    tally = {};
    const std::size_t end = first_of_job(job + 1);
    for (std::size_t i = first_of_job(job); i < end; ++i) {
      prefetch_active(i, end);
      auto& known = records.known(active[i]);
      const bool begins = !records.is_begun(known);
      Record& record = record_of(known);
      tally.large += begins && record.large;
      allowed(record);
      bool over = false;
      if (opens(record, step, over)) rounds.answer(known.record, record, step, scratch);
      conclude(i, record, tally);
    }
  });
  for (std::size_t job = 0; job < job_count; ++job) large_pairs += tallies[job].large;
  fronts.prepare(large_pairs);
  rounds.give_fronts(records, step);
  return work;
}

// The events of a job's records, and of those that have ended among them, which come first.
void Detector::State::write_events(std::size_t job, Step step, std::size_t ended_to) noexcept {
  const std::size_t end = first_of_job(job + 1);
  std::size_t next = tallies[job].ended_from, to = tallies[job].events_from;
  for (std::size_t i = first_of_job(job); i < end; ++i) {
    prefetch_active(i, end);
    const auto& known = records.known(active[i]);
    for (; next < ended_to && !(known.pair < BodyPair{ended[next].a.index, ended[next].b.index}); ++next) {
      events[to++] = ended[next];
    }
    const auto outcome = static_cast<Outcome>(marks[i]);
    if (outcome == Outcome::nothing) continue;
    describe(records[known.record], step, static_cast<PairChange>(outcome), events[to++]);
  }
  for (; next < ended_to; ++next) events[to++] = ended[next];
}

void Detector::State::tally_all() {
  detail::grow(marks, active_count);
  job_count = std::max<std::size_t>(1, (active_count + kPerJob - 1) / kPerJob);
  detail::grow(tallies, job_count);
  auto tally_some = [&](std::size_t job) { tally(job, tallies[job]); };
  run_jobs(options.executor, job_count, tally_some);
}

// In ascending order of pairs; what has ended of a pair comes before what has begun.
void Detector::State::report(Step step, Frame& frame) {
  const auto pair_of = [](const PairEvent& event) { return BodyPair{event.a.index, event.b.index}; };
  const auto by_pair = [&](const PairEvent& p, const PairEvent& q) { return pair_of(p) < pair_of(q); };
  // Teleports come after all others.
  if (!std::is_sorted(ended.begin(), ended.end(), by_pair)) std::sort(ended.begin(), ended.end(), by_pair);
  const std::size_t jobs = job_count;
  std::size_t written = event_count;
  for (std::size_t job = 0; job < jobs; ++job) {
    Tally& of = tallies[job];
    frame.certain += of.certain;
    frame.worst_bound = std::max(frame.worst_bound, of.worst_bound);
    of.events_from = written;
    if (job > 0) {
      const BodyPair first = records.pair(active[first_of_job(job)]);
      const auto from = std::partition_point(ended.begin(), ended.end(),
                                             [&](const PairEvent& event) { return pair_of(event) < first; });
      of.ended_from = static_cast<std::size_t>(from - ended.begin());
      of.events_from += of.ended_from - tallies[job - 1].ended_from;
    }
    written = of.events_from + of.events;
  }
  written += ended.size() - tallies[jobs - 1].ended_from;
  detail::grow(events, written);
  auto write_some = [&](std::size_t job) {
    write_events(job, step, job + 1 < jobs ? tallies[job + 1].ended_from : ended.size());
  };
  run_jobs(options.executor, jobs, write_some);
  event_count = written;
  ended.clear();
}

}  // namespace orchard::runtime
