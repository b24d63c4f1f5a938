#include <algorithm>
#include <limits>

#include "detector/rounds.h"

namespace orchard::runtime::detail {
namespace {

// Nobody knows what was in between.
void leave_open(Record& record) noexcept {
  if (record.verdict.answer == Answer::yes) return;
  record.verdict.answer = Answer::maybe;
  record.answered = -1;
}

}  // namespace

void Rounds::sweep_one(Record& record, Step now, QueryPool::Scratch& scratch, std::uint64_t most) const noexcept {
  PartPair from, to;
  const bool half = is_half_space(record.pair.b);
  if (half) from.half = to.half = places_->half_space(record.pair.b);
  Swept first;
  first.from = first.to = 2;
  double earliest = 2;
  for (std::uint32_t i = 0; i < places_->parts(record.pair.a); ++i) {
    places_->place_before(record.pair.a, i, now, from.a);
    places_->place(record.pair.a, i, to.a);
    for (std::uint32_t j = 0; j < places_->parts(record.pair.b); ++j) {
      places_->place_before(record.pair.b, j, now, from.b);
      places_->place(record.pair.b, j, to.b);
      Swept swept;
      if (scratch.work < most) {
        swept = sweep(scratch.workspace, from, to, most, scratch.work);
      } else {
        swept.answer = Answer::maybe;  // nobody has looked
      }
      if (swept.answer == Answer::no) continue;
      earliest = std::min(earliest, swept.from);
      const bool better = swept.answer != first.answer ? swept.answer > first.answer : swept.from < first.from;
      if (!better) continue;
      first = swept;
      record.part_a = i, record.part_b = j;
    }
  }
  if (first.answer == Answer::no) return;
  record.impact = true;
  record.impact_from = earliest;
  record.impact_to = first.answer == Answer::yes ? first.to : std::numeric_limits<double>::quiet_NaN();
  if (record.verdict.answer == Answer::yes) return;
  if (first.answer == Answer::yes) {
    record.verdict = first.verdict;
  } else {
    leave_open(record);
  }
}

bool Rounds::sweeps(const RecordTable& records, std::span<const std::uint32_t> open) noexcept {
  return std::any_of(open.begin(), open.end(), [&](std::uint32_t index) { return records[index].swept; });
}

void Rounds::sweep_all(RecordTable& records, std::span<const std::uint32_t> open, Step now, StepBudget& budget) {
  sweeps_.clear();
  for (const std::uint32_t index : open) {
    if (records[index].swept) sweeps_.push_back(index);
    if (records[index].unseen) leave_open(records[index]);
  }
  if (sweeps_.empty()) return;
  std::size_t done = 0;
  while (done < sweeps_.size() && budget.may_sweep(done)) {
    const std::size_t count = budget.limited() ? 1 : sweeps_.size() - done;
    const std::uint64_t most = budget.left();
    for (std::size_t job = 0; job < queries_->jobs(); ++job) queries_->scratch(job).work = 0;
    in_parallel(count, [&](std::size_t begin, std::size_t end, QueryPool::Scratch& scratch) {
      for (std::size_t i = begin; i < end; ++i) sweep_one(records[sweeps_[done + i]], now, scratch, most);
    });
    for (std::size_t job = 0; job < queries_->jobs(); ++job) budget.spend(queries_->scratch(job).work);
    done += count;
  }
  for (; done < sweeps_.size(); ++done) leave_open(records[sweeps_[done]]);
}

}  // namespace orchard::runtime::detail
