#include "detector/rounds.h"

#include <algorithm>

#include "collision/coherent_pair.h"
#include "collision/pair_query.h"

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

namespace {

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

// As take_in() of what unasked() would say of them.
void take_in_apart(Record& record, const PartsApart& apart) noexcept {
  Verdict& verdict = record.verdict;
  if (verdict.answer == Answer::no && apart.gap.most < verdict.separation_bound) {
    const double lower = verdict.lower_bound;
    const std::uint64_t work = verdict.work;
    verdict = Verdict{};
    verdict.answer = Answer::no;
    verdict.separation_bound = apart.gap.most, verdict.lower_bound = lower;
    verdict.work = work;
    record.part_a = apart.part_a, record.part_b = apart.part_b;
  }
  verdict.separation_bound = std::min(verdict.separation_bound, apart.gap.most);
  verdict.lower_bound = std::min(verdict.lower_bound, apart.gap.least);
}

}  // namespace

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
      record.along = query_of(scratch.workspace.narrow).apart_along();
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
    ::new (&verdict) Verdict(answer_exactly(query_of(scratch.workspace.narrow), pair, scratch.work, kNoLimit, guess));
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

// Two parts that touched at the step before, where a triangle `guess` may have been nearest. Where others of these
// shapes have met is no more than a guess.
Verdict Rounds::answer_again(Record& record, std::uint32_t guess, const PartPair& pair,
                             QueryPool::Scratch& scratch) noexcept {
  const bool known = record.met && !pair.simple() && pair.a.rigid && pair.b.rigid &&
                     &record.trees.a() == &pair.a.shape->prepared && &record.trees.b() == &pair.b.shape->prepared;
  if (!known) return answer_exactly(query_of(scratch.workspace.narrow), pair, scratch.work, kNoLimit, guess);
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
  const Verdict verdict = answer_exactly(query_of(scratch.workspace.narrow), pair, scratch.work);
  record.met = verdict.answer == Answer::yes && !pair.simple();
  if (!record.met) return verdict;
  record.trees = TreePair(pair.a.shape->prepared, pair.b.shape->prepared);
  CoherentPair::remember(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose());
  return verdict;
}

// Parts of bodies that are not `but`, until two touch: most are told apart by their spheres, before anybody needs to
// know how they are turned. Whether all answers are certain.
bool Rounds::answer_others(Record& record, const PartIndices& but, PartPair& pair,
                           QueryPool::Scratch& scratch) const noexcept {
  const BodyPair& bodies = record.pair;
  const std::uint32_t parts_a = places_->parts(bodies.a), parts_b = places_->parts(bodies.b);
  const bool half = is_half_space(bodies.b);
  bool certain = true, placed_b = false;
  PartsApart apart;
  PlacedSphere b = half || parts_b > 1 ? PlacedSphere{} : places_->sphere(bodies.b, 0);
  for (std::uint32_t i = 0; i < parts_a && record.verdict.answer != Answer::yes; ++i) {
    const PlacedSphere a = places_->sphere(bodies.a, i);
    bool placed_a = false;
    for (std::uint32_t j = 0; j < parts_b && record.verdict.answer != Answer::yes; ++j) {
      if (i == but.a && j == but.b) continue;
      if (parts_b > 1) b = places_->sphere(bodies.b, j);
      ++scratch.work;
      SphereGap gap = half ? sphere_gap(a, pair.half) : sphere_gap(a, b);
      if (!(gap.least > 0) && !half) gap.least = places_->bounds_gap(bodies, i, j, a, b);
      if (gap.least > 0) {
        apart.note(gap, i, j);
        continue;
      }
      if (!placed_a) places_->place(bodies.a, i, pair.a);
      if (!placed_b) places_->place(bodies.b, j, pair.b);
      placed_a = true, placed_b = parts_b == 1;
      const Verdict verdict = answer_anew(record, pair, scratch);
      take_in(record, verdict, i, j);
      certain = certain && verdict.answer != Answer::maybe;
    }
  }
  if (record.verdict.answer != Answer::yes && apart.gap.least < std::numeric_limits<double>::infinity())
    take_in_apart(record, apart);
  return certain;
}

// Bodies of several parts: those that touched mostly still do, and then nobody else is asked.
void Rounds::answer_parts(Record& record, Step now, QueryPool::Scratch& scratch) const noexcept {
  const std::uint64_t before = scratch.work;
  PartPair pair;
  if (is_half_space(record.pair.b)) pair.half = places_->half_space(record.pair.b);
  PartIndices touched;
  std::uint32_t guess = kNoTriangle;
  if (record.verdict.answer == Answer::yes) {
    touched = {record.part_a, record.part_b};
    place(record, touched.a, touched.b, pair);
    guess = nearest_triangle(record.verdict, pair);
  }
  forget_answer(record);
  bool certain = true;
  if (touched.a != kNoPart) {
    ++scratch.work;
    const Verdict verdict = answer_again(record, guess, pair, scratch);
    take_in(record, verdict, touched.a, touched.b);
    certain = verdict.answer != Answer::maybe;
  }
  certain = answer_others(record, touched, pair, scratch) && certain && record.verdict.answer != Answer::maybe;
  if (certain || record.verdict.answer == Answer::yes) record.answered = now;
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
