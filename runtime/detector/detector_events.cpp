#include <algorithm>

#include "detector_state.h"

// From pairs of spheres to records, and from answers to events.
namespace orchard::runtime {

using detail::Body;
using detail::is_half_space;
using detail::Record;

void Detector::State::note(const Record& record, Step step, PairChange change, std::vector<PairEvent>& to) {
  PairEvent& event = to.emplace_back();
  event.change = change;
  event.a = record.a, event.b = record.b;
  event.part_a = record.part_a, event.part_b = record.part_b;
  event.time = clock.time(step);
  event.verdict = record.verdict;
  if (!record.impact) return;
  event.impact_from = clock.time(step) + (record.impact_from - 1) * clock.time_step;
  event.impact_to = clock.time(step) + (record.impact_to - 1) * clock.time_step;
}

// Whether they are as far apart as at the last certain "no", but for less than what was between them then.
bool Detector::State::clear(const detail::RecordTable::Known& known) const noexcept {
  const detail::Clearance now = clearance_now(known.pair), &then = known.clearance;
  const double moved = detail::length(now.way - then.way) + (now.turned - then.turned);
  return now.changes == then.changes && moved + now.distance < then.distance * (1 - 1e-9);
}

// Of two bodies as they are, with what their middles may be off by in place of a distance.
detail::Clearance Detector::State::clearance_now(const BodyPair& pair) const noexcept {
  const detail::Whereabouts& a = bodies.whereabouts(pair.a);
  if (is_half_space(pair.b)) return {a.slack, -1.0 * a.middle, a.turned, a.changes};
  const detail::Whereabouts& b = bodies.whereabouts(pair.b);
  return {a.slack + b.slack, b.middle - a.middle, a.turned + b.turned, a.changes + b.changes};
}

// After a certain "no". What is swept is asked at each step.
void Detector::State::keep_clearance(detail::RecordTable::Known& known, const Record& record) const noexcept {
  const Body &a = places.body(record.pair.a), &b = places.body(record.pair.b);
  const bool lasts = record.verdict.answer == Answer::no && !record.touching && !(a.continuous_speed > 0) &&
                     !(b.continuous_speed > 0) && a.rigid && b.rigid && std::isfinite(record.verdict.lower_bound);
  if (!lasts) return;
  known.clearance = clearance_now(known.pair);
  known.clearance.distance = std::max(0.0, record.verdict.lower_bound - known.clearance.distance);
}

void Detector::State::match(Step step, Frame& frame) {
  known_pairs = records.known().size();
  fresh_pairs = parted_pairs = 0;
  const auto gone = [&](Record& record) {
    ++parted_pairs;
    // What the filters exclude is no pair of the broad phase's any more.
    const bool there = contains(record.a) && contains(record.b) && allowed(record);
    record.impact = false;
    record.verdict = Verdict{};
    record.verdict.answer = there ? Answer::no : Answer::maybe;
    record.verdict.separation_bound = std::numeric_limits<double>::infinity();
    if (there && record.touching && ++record.nos < options.steps_to_end) {
      record.apart = true;
      note(record, step, PairChange::stay, ended);
      return true;
    }
    if (record.touching) note(record, step, PairChange::end, ended);
    return false;
  };
  const auto fresh = [&](Record& record) {
    ++fresh_pairs;
    record.filter_version = filter_version - 1;
    const Body &a = places.body(record.pair.a), &b = places.body(record.pair.b);
    record.jumps = a.jumps + b.jumps;
    record.deformed = a.deformed + b.deformed;
    if (a.parts.size() != 1 || b.parts.size() != 1) return;
    const detail::Shape &of_a = shapes[a.parts[0].shape], &of_b = shapes[b.parts[0].shape];
    record.coherent = of_a.has_tree() && of_b.has_tree();
    if (record.coherent) record.trees = TreePair(of_a.prepared, of_b.prepared);
  };
  records.match(
      pairs, [this](BodyIndex index) { return id_of(index); },
      [&](const detail::RecordTable::Known& known) {
        const bool apart = clear(known);
        frame.certain += apart;
        return apart;
      },
      gone, fresh);
  frame.pairs += pairs.size();
}

bool Detector::State::allowed(Record& record) {
  const Body &a = places.body(record.pair.a), &b = places.body(record.pair.b);
  if (record.filter_version == filter_version && record.filters_a == a.filters && record.filters_b == b.filters) {
    return record.allowed;
  }
  record.filter_version = filter_version;
  record.filters_a = a.filters, record.filters_b = b.filters;
  record.allowed = (a.mask & b.group) != 0 && (b.mask & a.group) != 0 && (!filter || filter(record.a, record.b));
  return record.allowed;
}

// Neither has moved since the last certain answer.
bool Detector::State::reusable(const Record& record) const noexcept {
  const Body &a = places.body(record.pair.a), &b = places.body(record.pair.b);
  return record.answered >= 0 && std::max(a.moved, b.moved) <= record.answered && !record.impact;
}

// Which records have to be asked about.
void Detector::State::open_records(Step step) {
  open.clear();
  for (const std::uint32_t active : records.active()) {
    const auto& known = records(active);
    Record& record = records[known.record];
    const Body &a = places.body(record.pair.a), &b = places.body(record.pair.b);
    record.importance = std::max(a.importance, b.importance);
    if (!allowed(record)) continue;
    const bool continuous = a.continuous_speed > 0 || b.continuous_speed > 0;
    const std::uint32_t jumps = a.jumps + b.jumps;
    const auto known_before = [&](const Body& body) {
      return body.is_static || (body.frozen && body.asked < step) || body.known_before == step - 1;
    };
    record.swept = continuous && record.jumps == jumps && known_before(a) && known_before(b);
    // As spheres reach as far as a step leads, who was not asked for at the step before had nothing near then: unless
    // the broad phase could not tell, or its parts go farther now.
    const bool sphere_fell_short = interrupted || a.stretched == step - 1 || b.stretched == step - 1;
    record.unseen = continuous && record.jumps == jumps && !record.swept && sphere_fell_short;
    if (record.jumps != jumps && record.touching) {
      record.verdict = Verdict{};
      record.verdict.separation_bound = std::numeric_limits<double>::infinity();
      record.impact = false;
      note(record, step, PairChange::end, ended);
      record.touching = false;
      record.answered = -1;
    }
    record.jumps = jumps;
    if (record.deformed != a.deformed + b.deformed) {
      record.deformed = a.deformed + b.deformed;
      record.trees.forget();
    }
    if (!reusable(record)) open.push_back(known.record);
  }
}

void Detector::State::begin_or_end(Record& record, Step step, Frame& frame) {
  const Answer answer = record.verdict.answer;
  if (answer == Answer::maybe) {
    ++record.waited;
    frame.worst_bound = std::max(frame.worst_bound, record.verdict.separation_bound);
  } else {
    record.waited = 0;
    ++frame.certain;
  }
  if (answer == Answer::yes) {
    record.nos = 0;
    note(record, step, record.touching ? PairChange::stay : PairChange::begin, events);
    record.touching = true;
  } else if (record.touching) {
    record.nos = answer == Answer::no ? record.nos + 1 : 0;
    const bool end = record.nos >= options.steps_to_end;
    note(record, step, end ? PairChange::end : PairChange::stay, events);
    if (end) record.touching = false, record.nos = 0;
  } else if (answer == Answer::maybe) {
    note(record, step, PairChange::possible, events);
  }
}

// In ascending order of pairs; what has ended of a pair comes before what has begun.
void Detector::State::report(Step step, Frame& frame) {
  const auto by_pair = [](const PairEvent& p, const PairEvent& q) {
    return p.a.index != q.a.index ? p.a.index < q.a.index : p.b.index < q.b.index;
  };
  // Teleports come after all others.
  if (!std::is_sorted(ended.begin(), ended.end(), by_pair)) std::sort(ended.begin(), ended.end(), by_pair);
  auto next = ended.cbegin();
  const auto up_to = [&](const BodyPair& pair) {
    for (; next != ended.cend() && !(pair < BodyPair{next->a.index, next->b.index}); ++next) events.push_back(*next);
  };
  for (const std::uint32_t active : records.active()) {
    auto& known = records(active);
    Record& record = records[known.record];
    if (next != ended.cend()) up_to(known.pair);
    if (record.allowed) {
      begin_or_end(record, step, frame);
      keep_clearance(known, record);
    } else {
      ++frame.certain;  // that nothing is asked
      if (!record.touching) continue;
      record.touching = record.impact = false;
      record.verdict = Verdict{};
      record.answered = -1;
      note(record, step, PairChange::end, events);
    }
  }
  events.insert(events.end(), next, ended.cend());
  ended.clear();
}

}  // namespace orchard::runtime
