#include "detector/answer_pairs.h"

#include <algorithm>

#include "collision/coherent_pair.h"
#include "collision/pair_query.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

}  // namespace

void forget_answer(CachedPair& record) noexcept {
  record.verdict = {.answer = Answer::no, .separation_bound = kInfinity, .lower_bound = kInfinity};
  record.parts = {};
  record.sweep.impact = false;
}

void add(CachedPair& record, const Verdict& verdict, std::uint32_t part_a, std::uint32_t part_b) noexcept {
  const double upper = std::min(record.verdict.separation_bound, verdict.separation_bound);
  const double lower = std::min(record.verdict.lower_bound, verdict.lower_bound);
  const std::uint64_t work = record.verdict.work + verdict.work;
  if (decides(verdict, record.verdict)) {
    record.verdict = verdict;
    record.parts = {part_a, part_b};
  }
  record.verdict.separation_bound = upper;
  record.verdict.lower_bound = record.verdict.answer == Answer::yes ? 0 : lower;
  record.verdict.work = work;
}

void PairAnswerer::place(const CachedPair& record, std::uint32_t part_a, std::uint32_t part_b,
                         PartPair& pair) const noexcept {
  places_->place(record.bodies.a, part_a, pair.a);
  places_->place(record.bodies.b, part_b, pair.b);
}

// Answers a pair of bodies of one tree each, as most pairs are. If their spheres meet, it begins with what the last
// step found.
void PairAnswerer::answer_coherently(CachedPair& record, Step now, AnswerScratch& scratch) const noexcept {
  record.parts = {};
  record.sweep.impact = false;
  Verdict& verdict = record.verdict;
  PartPair pair;
  place(record, 0, 0, pair);
  const std::uint64_t before = scratch.work++;
  const double apart = length(pair.b.center - pair.a.center), reach = pair.a.reach + pair.b.reach;
  if (!(apart <= reach)) verdict = unasked(pair);
  if (apart <= reach || verdict.answer != Answer::no) {
    const double bound = apart <= reach ? apart + pair.a.reach + pair.b.reach : verdict.separation_bound;
    CoherentPair coherent(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose());
    if (!coherent.recall(verdict)) {
      ::new (&verdict) Verdict(coherent.search());
      record.apart_along = query_of(scratch.workspace.narrow).known().apart_along;
    }
    scratch.work += kPairWork + verdict.work;
    if (verdict.answer == Answer::no) make_solid(verdict, pair);
    verdict.separation_bound = std::min(verdict.separation_bound, bound);
  }
  if (verdict.answer != Answer::maybe) record.answered = now;
  verdict.work = scratch.work - before;
}

void PairAnswerer::answer(CachedPair& record, Step now, AnswerScratch& scratch) const noexcept {
  record.coherent ? answer_coherently(record, now, scratch) : answer_parts(record, now, scratch);
  if (record.sweep.unseen) leave_open(record);
  if (record.sweep.possible) sweep(record, now, scratch, kNoLimit);
}

// Answers for two parts that touched at the step before. `guess` is the triangle that may be nearest. `record.trees`
// may remember where two other parts of the same shapes met, because it is used as a first guess only.
Verdict PairAnswerer::answer_again(CachedPair& record, std::uint32_t guess, const PartPair& pair,
                                   AnswerScratch& scratch) noexcept {
  const bool known = record.met && !pair.simple() && pair.a.rigid && pair.b.rigid &&
                     &record.trees.a() == &pair.a.shape->prepared && &record.trees.b() == &pair.b.shape->prepared;
  if (!known) return answer_exactly(query_of(scratch.workspace.narrow), pair, scratch.work, kNoLimit, guess);
  CoherentPair coherent(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose());
  Verdict verdict;
  if (!coherent.recall(verdict)) verdict = coherent.search();
  scratch.work += kPairWork + verdict.work;
  make_solid(verdict, pair);
  return verdict;
}

// Answers for two parts about which nothing is remembered. If they are trees that meet, the record remembers where.
Verdict PairAnswerer::answer_new(CachedPair& record, const PartPair& pair, AnswerScratch& scratch) noexcept {
  const Verdict verdict = answer_exactly(query_of(scratch.workspace.narrow), pair, scratch.work);
  record.met = verdict.answer == Answer::yes && !pair.simple();
  if (!record.met) return verdict;
  record.trees = TreePair(pair.a.shape->prepared, pair.b.shape->prepared);
  CoherentPair(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose()).remember();
  return verdict;
}

// Compares all pairs of parts except `but`, until two of them touch. Most pairs are decided by their spheres, before
// the poses of the parts are needed. Returns whether all answers are certain.
bool PairAnswerer::answer_others(CachedPair& record, const std::optional<Parts>& but, PartPair& pair,
                                 AnswerScratch& scratch) const noexcept {
  const BodyPair& bodies = record.bodies;
  const std::uint32_t parts_a = places_->parts(bodies.a), parts_b = places_->parts(bodies.b);
  const HalfSpace* const half = is_half_space(bodies.b) ? &places_->half_space(bodies.b) : nullptr;
  bool certain = true, placed_b = false;
  BoundingSphere b = half != nullptr || parts_b > 1 ? BoundingSphere{} : places_->sphere(bodies.b, 0);
  for (std::uint32_t i = 0; i < parts_a && record.verdict.answer != Answer::yes; ++i) {
    const BoundingSphere a = places_->sphere(bodies.a, i);
    bool placed_a = false;
    for (std::uint32_t j = 0; j < parts_b && record.verdict.answer != Answer::yes; ++j) {
      if (but == Parts{i, j}) continue;
      if (parts_b > 1) b = places_->sphere(bodies.b, j);
      ++scratch.work;
      SphereGap gap = half != nullptr ? sphere_gap(a, *half) : sphere_gap(a, b);
      if (!(gap.least > 0) && half == nullptr && parts_a + parts_b > 2)
        gap.least = places_->bounds_gap(bodies, i, j, a, b);
      if (gap.least > 0) {
        add(record, {.answer = Answer::no, .separation_bound = gap.most, .lower_bound = gap.least}, i, j);
        continue;
      }
      if (!placed_a) places_->place(bodies.a, i, pair.a);
      if (!placed_b) places_->place(bodies.b, j, pair.b);
      placed_a = true, placed_b = parts_b == 1;
      const Verdict verdict = answer_new(record, pair, scratch);
      add(record, verdict, i, j);
      certain = certain && verdict.answer != Answer::maybe;
    }
  }
  return certain;
}

// Answers any other pair. Two parts that touched at the last step mostly still touch, so they are compared first; if
// they do, no other parts are compared.
void PairAnswerer::answer_parts(CachedPair& record, Step now, AnswerScratch& scratch) const noexcept {
  const std::uint64_t before = scratch.work;
  PartPair pair;
  std::optional<Parts> touched;
  std::uint32_t guess = kNoTriangle;
  if (record.verdict.answer == Answer::yes) {
    touched = record.parts;
    place(record, record.parts[0], record.parts[1], pair);
    guess = nearest_triangle(record.verdict, pair);
  }
  forget_answer(record);
  bool certain = true;
  if (touched) {
    ++scratch.work;
    const Verdict verdict = answer_again(record, guess, pair, scratch);
    add(record, verdict, (*touched)[0], (*touched)[1]);
    certain = verdict.answer != Answer::maybe;
  }
  certain = answer_others(record, touched, pair, scratch) && certain && record.verdict.answer != Answer::maybe;
  if (certain || record.verdict.answer == Answer::yes) record.answered = now;
  record.verdict.work = scratch.work - before;
}

void leave_open(CachedPair& record) noexcept {
  if (record.verdict.answer == Answer::yes) return;
  record.verdict.answer = Answer::maybe;
  record.answered = -1;
}

void PairAnswerer::sweep(CachedPair& record, Step now, AnswerScratch& scratch, std::uint64_t most) const noexcept {
  PartPair from, to;
  Swept first{.from = 2, .to = 2};
  double earliest = 2;
  for (std::uint32_t i = 0; i < places_->parts(record.bodies.a); ++i) {
    for (std::uint32_t j = 0; j < places_->parts(record.bodies.b); ++j) {
      place(record, i, j, to);
      places_->place_before(record.bodies.a, i, now, from.a);
      places_->place_before(record.bodies.b, j, now, from.b);
      Swept swept;
      if (scratch.work < most) {
        swept = detail::sweep(scratch.workspace, from, to, most, scratch.work);
      } else {
        swept.answer = Answer::maybe;  // not searched: the limit of work is reached
      }
      if (swept.answer == Answer::no) continue;
      earliest = std::min(earliest, swept.from);
      const bool better = swept.answer != first.answer ? swept.answer > first.answer : swept.from < first.from;
      if (!better) continue;
      first = swept;
      record.parts = {i, j};
    }
  }
  if (first.answer == Answer::no) return;
  record.sweep.impact = true;
  record.sweep.impact_from = earliest;
  record.sweep.impact_to = first.answer == Answer::yes ? first.to : std::numeric_limits<double>::quiet_NaN();
  if (record.verdict.answer == Answer::yes) return;
  if (first.answer == Answer::yes) {
    record.verdict = first.verdict;
  } else {
    leave_open(record);
  }
}

}  // namespace orchard::runtime::detail
