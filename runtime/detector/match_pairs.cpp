#include "detector/detector_state.h"

// The pairs of a step beside those of the step before: records of those that stay, and what ends with those that go.
namespace orchard::runtime {

using detail::Body;
using detail::is_half_space;
using detail::Record;

// Its record, from the first time on that it is asked for.
Record& Detector::State::record_of(detail::RecordTable::Known& known) noexcept {
  if (records.is_begun(known)) return records[known.record];
  Record& record = records.begin(known);
  record.pair = known.pair;
  record.a = id_of(known.pair.a), record.b = id_of(known.pair.b);
  record.filter_version = filter_version - 1;
  const Body &a = places.body(record.pair.a), &b = places.body(record.pair.b);
  record.jumps = a.jumps + b.jumps;
  record.deformed = a.deformed + b.deformed;
  if (!a.one || !b.one) return record;
  const detail::Shape &of_a = shapes[a.shape], &of_b = shapes[b.shape];
  record.coherent = of_a.has_tree() && of_b.has_tree();
  if (!record.coherent) return record;
  record.trees = TreePair(of_a.prepared, of_b.prepared);
  record.large = detail::FrontPool::are_large(record.trees);
  return record;
}

// Of a held pair that is no more. True: its touch goes on for a while.
bool Detector::State::parts(const detail::RecordTable::Known& known, Step step) {
  Record& record = records[known.record];
  // What the filters exclude is no pair of the broad phase's any more.
  const bool there = contains(record.a) && contains(record.b) && allowed(record);
  const bool jumped = there && record.jumps != places.body(record.pair.a).jumps + places.body(record.pair.b).jumps;
  record.impact = false;
  record.answered = -1;
  record.verdict = Verdict{};
  record.verdict.answer = there ? Answer::no : Answer::maybe;
  record.verdict.separation_bound = std::numeric_limits<double>::infinity();
  if (there && !jumped && record.touching && ++record.nos < options.steps_to_end) {
    describe(record, step, PairChange::stay, ended.emplace_back());
    return true;
  }
  if (record.touching) describe(record, step, PairChange::end, ended.emplace_back());
  fronts.give_back(record);
  large_pairs -= record.large;
  return false;
}

void Detector::State::match(Step step, Frame& frame) {
  pairs_seen.known = records.size(), pairs_seen.fresh = 0;
  const auto generations = [this](const BodyPair& pair) {
    const std::uint32_t first = bodies.whereabouts(pair.a).generation;
    return is_half_space(pair.b) ? first : first + bodies.whereabouts(pair.b).generation;
  };
  const bool any = bodies.any_disturbed();
  const auto doubted = [&](const BodyPair& pair) {
    return any && (bodies.disturbed(pair.a) || (!is_half_space(pair.b) && bodies.disturbed(pair.b)));
  };
  const auto same = [&](const detail::RecordTable::Known& known) {
    return known.generations == generations(known.pair);
  };
  const auto gone = [&](const detail::RecordTable::Known& known) { return parts(known, step); };
  const auto fresh = [&](const BodyPair& pair) {
    ++pairs_seen.fresh;
    return generations(pair);
  };
  const auto load = [this](const BodyPair& pair) ORCHARD_INLINE_LAMBDA { bodies.prefetch_whereabouts(pair.b); };
  records.match(pairs.all(), doubted, same, gone, fresh, load);
  pairs_seen.parted = pairs_seen.known + pairs_seen.fresh + records.kept().size() - records.size();
  bodies.forget_disturbed();
  find_active();
  frame.pairs += pairs.all().size();
  frame.certain += pairs.all().size() - active_count;
}

bool Detector::State::allowed(Record& record) {
  const Body &a = places.body(record.pair.a), &b = places.body(record.pair.b);
  if (record.filter_version == filter_version && record.filters_a == a.filters && record.filters_b == b.filters) {
    return record.allowed;
  }
  record.filter_version = filter_version;
  record.filters_a = a.filters, record.filters_b = b.filters;
  record.allowed = detail::filters_allow(a, b) && (!filter || filter(record.a, record.b));
  return record.allowed;
}

}  // namespace orchard::runtime
