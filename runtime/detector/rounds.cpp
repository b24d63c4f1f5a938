#include "rounds.h"

#include <algorithm>

#include "pair/coherent_pair.h"
#include "pair/pair_access.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
constexpr double kSlow = 0.02;  // of the smaller body's size, per step

}  // namespace

void forget_answer(Record& record) noexcept {
  record.verdict = Verdict{};
  record.verdict.answer = Answer::no;
  record.verdict.separation_bound = record.verdict.lower_bound = std::numeric_limits<double>::infinity();
  record.part_a = record.part_b = 0;
  record.impact = false;
}

void take_in(Record& record, const Verdict& verdict, std::uint32_t part_a, std::uint32_t part_b) noexcept {
  const double upper = std::min(record.verdict.separation_bound, verdict.separation_bound);
  const double lower = std::min(record.verdict.lower_bound, verdict.lower_bound);
  const std::uint64_t work = record.verdict.work + verdict.work;
  if (decides(verdict, record.verdict)) {
    record.verdict = verdict;
    record.part_a = part_a, record.part_b = part_b;
  }
  record.verdict.separation_bound = upper;
  record.verdict.lower_bound = record.verdict.answer == Answer::yes ? 0 : lower;
  record.verdict.work = work;
}

// Of parts that are apart by their bounds: how far at least, and the two of whom it is known best how far at most.
struct PartsApart {
  SphereGap gap{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  std::uint32_t part_a = 0, part_b = 0;

  void note(const SphereGap& of, std::uint32_t i, std::uint32_t j) noexcept {
    gap.least = std::min(gap.least, of.least);
    if (!(of.most < gap.most)) return;
    gap.most = of.most;
    part_a = i, part_b = j;
  }
};

// take_in() of what unasked() says of them.
void Rounds::take_in_apart(Record& record, const PartsApart& apart, PartPair& pair) const noexcept {
  const double lower = std::min(record.verdict.lower_bound, apart.gap.least);
  if (record.verdict.answer == Answer::no && apart.gap.most < record.verdict.separation_bound) {
    const std::uint64_t work = record.verdict.work;
    places_->place_sphere(record.pair.a, apart.part_a, pair.a);
    places_->place_sphere(record.pair.b, apart.part_b, pair.b);
    record.verdict = unasked(pair, apart.gap);
    record.verdict.work = work;
    record.part_a = apart.part_a, record.part_b = apart.part_b;
  }
  record.verdict.separation_bound = std::min(record.verdict.separation_bound, apart.gap.most);
  record.verdict.lower_bound = lower;
}

void Rounds::place(const Record& record, std::uint32_t part_a, std::uint32_t part_b, PartPair& pair) const noexcept {
  places_->place(record.pair.a, part_a, pair.a);
  places_->place(record.pair.b, part_b, pair.b);
  if (pair.b.shape == nullptr) pair.half = places_->half_space(record.pair.b);
}

// Unless they pass each other so fast that looking for what lasts would not pay.
bool Rounds::is_slow(Record& record, const PartPair& pair, Step now) noexcept {
  const Vec3 way = pair.b.center - pair.a.center, change = way - record.apart_by;
  const bool first = record.apart_at < 0;
  const double slow =
      kSlow * std::min(pair.a.reach, pair.b.reach) * static_cast<double>(std::max<Step>(1, now - record.apart_at));
  record.apart_by = way;
  record.apart_at = now;
  return first || dot(change, change) <= slow * slow;
}

// Two bodies of one tree each, as most are: what the last step found is where this one begins.
void Rounds::answer_coherently(std::uint32_t index, Record& record, Step now,
                               QueryPool::Scratch& scratch) const noexcept {
  record.part_a = record.part_b = 0;
  record.impact = false;
  Verdict& verdict = record.verdict;
  PartPair pair;
  place(record, 0, 0, pair);
  const std::uint64_t before = scratch.work++;
  const bool slow = is_slow(record, pair, now);
  const double apart = length(record.apart_by), reach = pair.a.reach + pair.b.reach;
  if (!(apart <= reach)) verdict = unasked(pair);
  if (apart <= reach || verdict.answer != Answer::no) {
    const double bound = apart <= reach ? apart + pair.a.reach + pair.b.reach : verdict.separation_bound;
    const bool tries = slow || record.touching;
    if (!tries || !CoherentPair::recall(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose(), verdict)) {
      ::new (&verdict) Verdict(CoherentPair::search(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose()));
      if (slow && verdict.answer == Answer::no) note_search(index, record, verdict.work, scratch);
      record.along = PairAccess::apart_along(scratch.workspace.narrow);
    }
    scratch.work += kPairWork + verdict.work;
    if (verdict.answer == Answer::no) make_solid(verdict, pair);
    verdict.separation_bound = std::min(verdict.separation_bound, bound);
  }
  if (verdict.answer != Answer::maybe) record.answered = now;
  verdict.work = scratch.work - before;
}

// Two bodies of one part each, at least one of them a simple shape.
void Rounds::answer_two_parts(Record& record, Step now, QueryPool::Scratch& scratch) const noexcept {
  Verdict& verdict = record.verdict;
  PartPair pair;
  place(record, 0, 0, pair);
  const std::uint32_t guess = nearest_triangle(verdict, pair);
  const std::uint64_t before = scratch.work++;
  record.part_a = record.part_b = 0;
  record.impact = false;
  if (spheres_part(pair)) {
    verdict = unasked(pair);
  } else {
    ::new (&verdict) Verdict(answer_exactly(scratch.workspace.narrow, pair, scratch.work, kNoLimit, guess));
  }
  if (verdict.answer == Answer::yes) verdict.lower_bound = 0;
  if (verdict.answer != Answer::maybe) record.answered = now;
  verdict.work = scratch.work - before;
}

void Rounds::answer(std::uint32_t index, Record& record, Step now, QueryPool::Scratch& scratch) const noexcept {
  if (record.coherent) return answer_coherently(index, record, now, scratch);
  if (places_->parts(record.pair.a) == 1 && places_->parts(record.pair.b) == 1) {
    return answer_two_parts(record, now, scratch);
  }
  answer_parts(record, now, scratch);
}

// Two parts that touched at the step before. Where others of these shapes have met is no more than a guess.
Verdict Rounds::answer_again(Record& record, const Verdict& last, const PartPair& pair,
                             QueryPool::Scratch& scratch) noexcept {
  const bool known = record.met && !pair.simple() && pair.a.rigid && pair.b.rigid &&
                     &record.trees.a() == &pair.a.shape->prepared && &record.trees.b() == &pair.b.shape->prepared;
  if (!known) {
    return answer_exactly(scratch.workspace.narrow, pair, scratch.work, kNoLimit, nearest_triangle(last, pair));
  }
  const Pose &a = pair.a.pose(), &b = pair.b.pose();
  Verdict verdict;
  if (!CoherentPair::recall(scratch.workspace, record.trees, a, b, verdict)) {
    verdict = CoherentPair::search(scratch.workspace, record.trees, a, b);
  }
  scratch.work += kPairWork + verdict.work;
  make_solid(verdict, pair);
  return verdict;
}

// Of two parts of bodies, what is new.
Verdict Rounds::answer_anew(Record& record, const PartPair& pair, QueryPool::Scratch& scratch) noexcept {
  const Verdict verdict = answer_exactly(scratch.workspace.narrow, pair, scratch.work);
  record.met = verdict.answer == Answer::yes && !pair.simple();
  if (!record.met) return verdict;
  record.trees = TreePair(pair.a.shape->prepared, pair.b.shape->prepared);
  CoherentPair::remember(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose());
  return verdict;
}

// Bodies of several parts: those that touched mostly still do, and then nobody else is asked. Most of the others are
// told apart by their spheres, before anybody needs to know how they are turned.
void Rounds::answer_parts(Record& record, Step now, QueryPool::Scratch& scratch) const noexcept {
  const bool touched = record.verdict.answer == Answer::yes;
  const Verdict last = record.verdict;
  const std::uint32_t last_a = record.part_a, last_b = record.part_b;
  forget_answer(record);
  PartPair pair;
  const std::uint32_t parts_a = places_->parts(record.pair.a), parts_b = places_->parts(record.pair.b);
  const std::uint64_t before = scratch.work;
  bool known = true;
  const auto take = [&](const Verdict& verdict, std::uint32_t i, std::uint32_t j) {
    take_in(record, verdict, i, j);
    known = known && verdict.answer != Answer::maybe;
  };
  const bool half = is_half_space(record.pair.b);
  if (half) pair.half = places_->half_space(record.pair.b);
  if (touched) {
    place(record, last_a, last_b, pair);
    ++scratch.work;
    take(answer_again(record, last, pair, scratch), last_a, last_b);
  }
  PartsApart apart;
  PlacedSphere b = half || parts_b > 1 ? PlacedSphere{} : places_->sphere(record.pair.b, 0);
  bool placed_b = false;
  for (std::uint32_t i = 0; i < parts_a && record.verdict.answer != Answer::yes; ++i) {
    const PlacedSphere a = places_->sphere(record.pair.a, i);
    bool placed_a = false;
    for (std::uint32_t j = 0; j < parts_b && record.verdict.answer != Answer::yes; ++j) {
      if (touched && i == last_a && j == last_b) continue;
      if (parts_b > 1) b = places_->sphere(record.pair.b, j);
      ++scratch.work;
      SphereGap gap = half ? sphere_gap(a, pair.half) : sphere_gap(a, b);
      if (!(gap.least > 0) && !half) gap.least = places_->bounds_gap(record.pair, i, j, a, b);
      if (gap.least > 0) {
        apart.note(gap, i, j);
        continue;
      }
      if (!placed_a) places_->place(record.pair.a, i, pair.a);
      if (!placed_b) places_->place(record.pair.b, j, pair.b);
      placed_a = true, placed_b = parts_b == 1;
      take(answer_anew(record, pair, scratch), i, j);
    }
  }
  if (record.verdict.answer != Answer::yes && apart.gap.least < std::numeric_limits<double>::infinity())
    take_in_apart(record, apart, pair);
  if (record.verdict.answer == Answer::maybe) known = false;
  if (known || record.verdict.answer == Answer::yes) record.answered = now;
  record.verdict.work = scratch.work - before;
}

std::uint64_t Rounds::answer_all(RecordTable& records, std::span<const std::uint32_t> open, Step now) {
  const std::size_t among = jobs(open.size());
  const std::uint64_t work = answer_by(among, [&](std::size_t job, QueryPool::Scratch& scratch) {
    const std::size_t end = open.size() * (job + 1) / among;
    for (std::size_t i = open.size() * job / among; i < end; ++i) {  // what a pair needs is all over memory
      constexpr std::size_t kRecord = 6, kBodies = 4;                // pairs ahead
      if (i + kRecord < end) prefetch_all(records[open[i + kRecord]]);
      if (i + kBodies < end) places_->prefetch_bodies(records[open[i + kBodies]].pair);
      answer(open[i], records[open[i]], now, scratch);
    }
  });
  give_fronts(records, now);
  return work;
}

void Rounds::note_search(std::uint32_t index, Record& record, std::uint64_t work,
                         QueryPool::Scratch& scratch) noexcept {
  if (scratch.wanting.capacity() == 0 || !FrontPool::wants(record, work)) return;
  if (scratch.wanting.size() < scratch.wanting.capacity()) scratch.wanting.push_back(index);
}

// Jobs take the pairs in their order, and what a job leaves out for want of room would not get a front anyway.
void Rounds::give_fronts(RecordTable& records, Step now) {
  for (std::size_t job = 0; job < queries_->jobs(); ++job) {
    auto& wanting = queries_->scratch(job).wanting;
    fronts_->give(records, wanting, now);
    wanting.clear();
  }
}

}  // namespace orchard::runtime::detail
