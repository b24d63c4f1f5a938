#include <algorithm>
#include <cmath>

#include "detector_state.h"

// From pairs of spheres to records.
namespace orchard::runtime {

using detail::Body;
using detail::is_half_space;
using detail::Record;

// Of two bodies as they are, with what their middles may be off by in place of a distance.
detail::Clearance Detector::State::clearance_now(const BodyPair& pair) const noexcept {
  const detail::Whereabouts& a = bodies.whereabouts(pair.a);
  if (is_half_space(pair.b)) return {a.slack, -1.0 * a.middle, a.turned, a.changes};
  const detail::Whereabouts& b = bodies.whereabouts(pair.b);
  return {a.slack + b.slack, b.middle - a.middle, a.turned + b.turned, a.changes + b.changes};
}

double Detector::State::travel_now(const BodyPair& pair) const noexcept {
  return bodies.travel(pair.a) + (is_half_space(pair.b) ? 0 : bodies.travel(pair.b));
}

// How far apart their spheres are, at least; below 0 where these tell nothing. As sphere_gap(), a little less.
double Detector::State::gap_of(const BodyPair& pair, const detail::Clearance& now) const noexcept {
  constexpr double kRounding = 1e-11;  // as there
  const detail::Whereabouts& a = bodies.whereabouts(pair.a);
  if (!(a.reach >= 0)) return -1;
  const double slack = (kRounding / 1e-14) * now.distance;
  if (is_half_space(pair.b)) {
    const detail::HalfSpace& half = places.half_space(pair.b);
    return dot(half.normal, a.middle) - half.offset - a.reach - slack - kRounding * std::fabs(half.offset);
  }
  const detail::Whereabouts& b = bodies.whereabouts(pair.b);
  if (!(b.reach >= 0)) return -1;
  return detail::length(now.way) - a.reach - b.reach - slack;
}

// Until when a distance lasts, from now on.
void Detector::State::wait_for(std::size_t place, double distance) noexcept {
  const double now = travel_now(records.pair(place));
  records.until(place) = distance > 0 ? (now + distance * (1 - 1e-9)) * (1 - 0x1p-50) : -1;
}

// Whether a pair is apart as far as what was known of it, or its spheres, tell; else it has to be asked about. What was
// known: they are as far apart as at the last certain "no", but for less than what was between them then.
Detector::State::Telling Detector::State::look_at(std::size_t place, Step step) noexcept {
  if (travel_now(records.pair(place)) < records.until(place)) return Telling::known;
  auto& known = records.known(place);
  const detail::Clearance now = clearance_now(known.pair);
  if (known.distance > 0 && now.changes == known.changes) {
    const double left = known.distance * (1 - 1e-9) - now.distance - (now.turned - known.turned);
    const Vec3 moved = now.way - known.way;
    const double square = dot(moved, moved);
    if (left > 0 && square < left * left * (1 - 1e-9)) {
      wait_for(place, left - std::sqrt(square));
      return Telling::known;
    }
  }
  known.distance = 0;
  records.until(place) = -1;
  if (known.record != detail::kNoRecord && !known.idle) return Telling::nothing;
  const double gap = gap_of(known.pair, now);
  if (!(gap > 0) || !std::isfinite(gap)) return Telling::nothing;
  known.way = now.way;
  known.way_at = static_cast<std::uint32_t>(step + 1);
  known.turned = now.turned;
  known.changes = now.changes;
  known.distance = std::max(0.0, gap - now.distance);
  wait_for(place, known.distance - now.distance);
  return Telling::spheres;
}

// The pairs that have to be asked about, and a record for each of these.
std::uint64_t Detector::State::find_active(Step step) {
  constexpr std::size_t kPerJob = 1024;
  const std::size_t pair_count = records.size();
  detail::grow(told, pair_count);
  auto look_at_some = [&](std::size_t job) {
    const std::size_t end = std::min(pair_count, (job + 1) * kPerJob);
    for (std::size_t place = job * kPerJob; place < end; ++place) told[place] = look_at(place, step);
  };
  run_jobs(options.executor, (pair_count + kPerJob - 1) / kPerJob, look_at_some);
  active.clear();
  std::uint64_t by_spheres = 0;
  for (std::size_t place = 0; place < pair_count; ++place) {
    if (told[place] == Telling::known) continue;
    by_spheres += told[place] == Telling::spheres;
    if (told[place] == Telling::spheres) continue;
    active.push_back(static_cast<std::uint32_t>(place));
    auto& known = records.known(place);
    if (known.record == detail::kNoRecord) begin_record(known);
  }
  return by_spheres;
}

void Detector::State::begin_record(detail::RecordTable::Known& known) {
  const std::uint32_t index = records.take();
  known.record = index & detail::kNoRecord;
  known.idle = 0;
  Record& record = records[index];
  record.pair = known.pair;
  record.a = id_of(known.pair.a), record.b = id_of(known.pair.b);
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
}

// Of a pair that is no more. True: its touch goes on for a while.
bool Detector::State::parts(const detail::RecordTable::Known& known, Step step) {
  ++parted_pairs;
  if (known.record == detail::kNoRecord) return false;
  Record& record = records[known.record];
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
}

// Returns what it costs.
std::uint64_t Detector::State::match(Step step, Frame& frame) {
  using Same = detail::RecordTable::Same;
  known_pairs = records.size();
  fresh_pairs = parted_pairs = 0;
  const auto generations = [this](const BodyPair& pair) {
    const std::uint32_t first = bodies.whereabouts(pair.a).generation;
    return is_half_space(pair.b) ? first : first + bodies.whereabouts(pair.b).generation;
  };
  const auto same = [&](const detail::RecordTable::Known& known) {
    const BodyPair& pair = known.pair;
    const bool disturbed = bodies.disturbed(pair.a) || (!is_half_space(pair.b) && bodies.disturbed(pair.b));
    if (!disturbed) return Same::yes;
    return known.generations == generations(pair) ? Same::doubtful : Same::no;
  };
  records.match(
      pairs, bodies.any_disturbed(), same,
      [&](const detail::RecordTable::Known& known) { return parts(known, step); },
      [&](const BodyPair& pair) {
        ++fresh_pairs;
        return generations(pair);
      });
  bodies.forget_disturbed();
  const std::uint64_t work = find_active(step);
  fronts.prepare(large_pairs);
  frame.pairs += pairs.size();
  frame.certain += records.size() - active.size() - records.kept();
  return work;
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
