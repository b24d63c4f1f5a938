#include <algorithm>

#include "detector_state.h"

// From pairs of spheres to records.
namespace orchard::runtime {

using detail::Body;
using detail::is_half_space;
using detail::Record;

// Whether they are as far apart as at the last certain "no", but for less than what was between them then.
bool Detector::State::clear(const detail::RecordTable::Known& known) const noexcept {
  const detail::Clearance now = clearance_now(known.pair), &then = known.clearance;
  const double left = then.distance * (1 - 1e-9) - now.distance - (now.turned - then.turned);
  const Vec3 moved = now.way - then.way;
  return now.changes == then.changes && left > 0 && dot(moved, moved) < left * left * (1 - 1e-9);
}

// Of two bodies as they are, with what their middles may be off by in place of a distance.
detail::Clearance Detector::State::clearance_now(const BodyPair& pair) const noexcept {
  const detail::Whereabouts& a = bodies.whereabouts(pair.a);
  if (is_half_space(pair.b)) return {a.slack, -1.0 * a.middle, a.turned, a.changes};
  const detail::Whereabouts& b = bodies.whereabouts(pair.b);
  return {a.slack + b.slack, b.middle - a.middle, a.turned + b.turned, a.changes + b.changes};
}

// For match(), by jobs: it is most of what a step costs where most pairs are clear. Of pairs that are no more, too.
void Detector::State::find_clear() {
  const auto known = records.known();
  if (clear_before_match.size() < known.size()) detail::grow(clear_before_match, known.size());
  constexpr std::size_t kPerJob = 1024;
  auto look_at_some = [&](std::size_t job) {
    const std::size_t end = std::min(known.size(), (job + 1) * kPerJob);
    for (std::size_t i = job * kPerJob; i < end; ++i) {
      clear_before_match[i] = known[i].clearance.distance > 0 && clear(known[i]) ? 1 : 0;
    }
  };
  run_jobs(options.executor, (known.size() + kPerJob - 1) / kPerJob, look_at_some);
}

void Detector::State::match(Step step, Frame& frame) {
  find_clear();
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
      describe(record, step, PairChange::stay, ended.emplace_back());
      return true;
    }
    if (record.touching) describe(record, step, PairChange::end, ended.emplace_back());
    fronts.give_back(record);
    large_pairs -= record.large;
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
    if (!record.coherent) return;
    record.trees = TreePair(of_a.prepared, of_b.prepared);
    record.large = detail::FrontPool::are_large(record.trees);
    large_pairs += record.large;
  };
  records.match(
      pairs, [this](BodyIndex index) { return id_of(index); },
      [this](const BodyPair& pair) {
        const std::uint32_t first = bodies.whereabouts(pair.a).generation;
        return is_half_space(pair.b) ? first : first + bodies.whereabouts(pair.b).generation;
      },
      [&](const detail::RecordTable::Known& known) {
        const bool apart = clear_before_match[static_cast<std::size_t>(&known - records.known().data())] != 0;
        frame.certain += apart;
        return apart;
      },
      gone, fresh);
  fronts.prepare(large_pairs);
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

}  // namespace orchard::runtime
