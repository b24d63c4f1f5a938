#include "rounds.h"

#include <algorithm>
#include <numeric>

namespace orchard::runtime::detail {
namespace {

constexpr std::uint64_t kFirstSlice = 256;   // tests, of a level of spheres
constexpr std::uint64_t kExactSlice = 1024;  // of the first exact slice; each further one is four times as large
constexpr std::uint64_t kDeepSlice = 4096;   // for who has waited
constexpr double kSlow = 0.005;              // of the smaller body's size, per step

// What a record knows before anything is asked: nobody's parts are near.
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

}  // namespace

void Rounds::place(const Record& record, std::uint32_t part_a, std::uint32_t part_b, PlacedPair& pair) const noexcept {
  places_->place(record.pair.a, part_a, pair.a);
  places_->place(record.pair.b, part_b, pair.b);
  if (pair.b.shape == nullptr) pair.half = places_->half_space(record.pair.b);
}

// Two bodies of one tree each, as most are: what the last step found is where this one begins, unless they pass each
// other so fast that looking for what lasts would not pay.
void Rounds::answer_coherently(Record& record, Step now, QueryPool::Scratch& scratch) const noexcept {
  forget_answer(record);
  PlacedPair pair;
  place(record, 0, 0, pair);
  const std::uint64_t before = scratch.work++;
  const Vec3 way = pair.b.center - pair.a.center, change = way - record.apart_by;
  record.apart_by = way;
  record.verdict = unasked(pair);
  if (record.verdict.answer != Answer::no) {
    const double slow = kSlow * std::min(pair.a.reach, pair.b.reach);
    if (dot(change, change) <= slow * slow) {
      const double bound = record.verdict.separation_bound;
      Verdict verdict = collide_coherently(scratch.workspace, record.trees, pair.a.pose, pair.b.pose);
      scratch.work += kPairWork + verdict.work;
      if (verdict.answer == Answer::no) verdict = solid_verdict(verdict, pair);
      record.verdict = verdict;
      record.verdict.separation_bound = std::min(verdict.separation_bound, bound);
    } else {
      record.verdict = answer_exactly(scratch.workspace.narrow, pair, scratch.work);
    }
  }
  if (record.verdict.answer != Answer::maybe) record.answered = now;
  record.verdict.work = scratch.work - before;
}

void Rounds::answer(Record& record, Step now, QueryPool::Scratch& scratch) const noexcept {
  if (record.coherent) return answer_coherently(record, now, scratch);
  forget_answer(record);
  PlacedPair pair;
  const std::uint32_t parts_a = places_->parts(record.pair.a), parts_b = places_->parts(record.pair.b);
  if (pair.b.shape == nullptr && is_half_space(record.pair.b)) pair.half = places_->half_space(record.pair.b);
  const std::uint64_t before = scratch.work;
  bool known = true;
  for (std::uint32_t i = 0; i < parts_a && record.verdict.answer != Answer::yes; ++i) {
    places_->place(record.pair.a, i, pair.a);
    for (std::uint32_t j = 0; j < parts_b && record.verdict.answer != Answer::yes; ++j) {
      places_->place(record.pair.b, j, pair.b);
      const double gap = sphere_gap(pair);
      ++scratch.work;
      const Verdict verdict = gap > 0 ? unasked(pair) : answer_exactly(scratch.workspace.narrow, pair, scratch.work);
      take_in(record, verdict, i, j);
      known = known && verdict.answer != Answer::maybe;
    }
  }
  if (record.verdict.answer == Answer::maybe) known = false;
  if (known || record.verdict.answer == Answer::yes) record.answered = now;
  record.verdict.work = scratch.work - before;
}

std::uint64_t Rounds::answer_all(RecordTable& records, std::span<const std::uint32_t> open, Step now) {
  for (std::size_t job = 0; job < queries_->jobs(); ++job) queries_->scratch(job).work = 0;
  in_parallel(open.size(), [&](std::size_t begin, std::size_t end, QueryPool::Scratch& scratch) {
    for (std::size_t i = begin; i < end; ++i) answer(records[open[i]], now, scratch);
  });
  std::uint64_t work = 0;
  for (std::size_t job = 0; job < queries_->jobs(); ++job) work += queries_->scratch(job).work;
  return work;
}

// A task for each two parts whose spheres overlap, in the order in which they are to be answered.
void Rounds::make_tasks(const RecordTable& records, std::span<const std::uint32_t> open) {
  tasks_.clear();
  for (const std::uint32_t index : open) {
    const Record& record = records[index];
    const std::uint32_t parts_a = places_->parts(record.pair.a), parts_b = places_->parts(record.pair.b);
    for (std::uint32_t i = 0; i < parts_a; ++i) {
      for (std::uint32_t j = 0; j < parts_b; ++j) {
        Task task;
        task.sequence = static_cast<std::uint32_t>(tasks_.size());
        task.record = index, task.part_a = i, task.part_b = j;
        task.importance = record.importance, task.waited = record.waited;
        tasks_.push_back(task);
      }
    }
  }
  std::sort(tasks_.begin(), tasks_.end(), [](const Task& p, const Task& q) {
    if (p.importance != q.importance) return p.importance < q.importance;
    return p.waited != q.waited ? p.waited > q.waited : p.sequence < q.sequence;
  });
}

// The spheres of the parts, the roots, and simple pairs at once: as many as the budget allows.
void Rounds::begin_tasks(StepBudget& budget, RecordTable& records) {
  std::size_t count = 0;
  std::uint64_t cost = 0;
  for (; count < tasks_.size() && cost < budget.left(); ++count) {
    const Task& task = tasks_[count];
    const Record& record = records[task.record];
    PlacedPair pair;
    place(record, task.part_a, task.part_b, pair);
    tasks_[count].simple = pair.simple();
    const bool apart = sphere_gap(pair) > 0;
    tasks_[count].done = apart;
    tasks_[count].verdict = unasked(pair);
    cost += apart ? 1 : task.simple ? kSimplePairWork : kPairWork;
  }
  for (std::size_t i = count; i < tasks_.size(); ++i) {
    PlacedPair pair;
    place(records[tasks_[i].record], tasks_[i].part_a, tasks_[i].part_b, pair);
    tasks_[i].verdict = unasked(pair);
    tasks_[i].done = tasks_[i].verdict.answer == Answer::no;
  }
  const bool alone = executor_->run == nullptr;
  in_parallel(count, [&](std::size_t begin, std::size_t end, QueryPool::Scratch& scratch) {
    for (std::size_t i = begin; i < end; ++i) {
      Task& task = tasks_[i];
      if (task.done || (alone ? !budget.may_begin(i) : budget.late())) continue;
      PlacedPair pair;
      place(records[task.record], task.part_a, task.part_b, pair);
      std::uint64_t work = 0;
      if (task.simple) {
        task.verdict = answer_exactly(scratch.workspace.narrow, pair, work);
        task.done = true;
        continue;
      }
      scratch.workspace.narrow.bind(pair.a.shape->prepared, pair.b.shape->prepared);
      scratch.workspace.narrow.start(pair.a.pose, pair.b.pose);
      task.verdict = verdict_of(scratch.workspace.narrow, pair);
      task.done = scratch.workspace.narrow.finished();
    }
  });
  budget.spend(cost);
}

void Rounds::refine_one(Task& task, const Record& record, std::uint64_t slice, bool by_level,
                        std::chrono::nanoseconds time) const noexcept {
  PlacedPair pair;
  place(record, task.part_a, task.part_b, pair);
  NarrowPhase& query = *task.query;
  if (!task.started) {
    query.bind(pair.a.shape->prepared, pair.b.shape->prepared);
    query.start(pair.a.pose, pair.b.pose);
    task.started = true;
  }
  const std::uint64_t before = query.work();
  const Budget budget{slice, time};
  if (by_level) {
    query.refine(budget);
  } else {
    query.refine_exactly(budget);
  }
  task.work = query.work() - before;
  task.done = query.finished();
  task.verdict = verdict_of(query, pair);
}

// One piece for each of order_, as far as `most` goes; what may run at once has its overshoot set aside, so that the
// budget holds.
void Rounds::refine_once(std::uint64_t slice, bool by_level, std::uint64_t most, StepBudget& budget,
                         RecordTable& records) {
  const bool alone = executor_->run == nullptr;
  for (std::size_t next = 0; next < order_.size();) {
    const std::uint64_t may = std::min(most, budget.left());
    if (may == 0 || !budget.may_refine()) return;
    const std::uint64_t at_once = std::min<std::uint64_t>(order_.size() - next, may / (slice + kMaxOvershoot));
    const auto count = static_cast<std::size_t>(std::max<std::uint64_t>(at_once, 1));
    const std::uint64_t piece = at_once > 0 ? slice : std::min(slice, may);
    in_parallel(count, [&](std::size_t from, std::size_t to, QueryPool::Scratch&) {
      for (std::size_t i = from; i < to; ++i) {
        Task& task = tasks_[order_[next + i]];
        task.work = 0;
        if (alone ? !budget.may_refine() : budget.late()) continue;
        refine_one(task, records[task.record], budget.piece(piece), by_level, budget.time_left());
        if (alone) budget.refined(task.work);
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      const Task& task = tasks_[order_[next + i]];
      budget.spend(task.work);
      most -= std::min(most, task.work);
      if (task.verdict.answer == Answer::yes) records[task.record].verdict.answer = Answer::yes;
    }
    next += count;
  }
}

// What is still open of a class.
void Rounds::order_open(std::size_t begin, std::size_t end, std::uint32_t min_waited, const RecordTable& records) {
  order_.clear();
  for (std::size_t i = begin; i < end; ++i) {
    Task& task = tasks_[i];
    if (task.done || task.simple || task.waited < min_waited) continue;
    if (records[task.record].verdict.answer == Answer::yes) continue;
    if (task.query == nullptr && (task.query = queries_->take(max_unfinished_)) == nullptr) continue;
    order_.push_back(static_cast<std::uint32_t>(i));
  }
}

// Half of it straight to certainty for those that have waited, one after the other: else a small budget would end
// before anybody gets anywhere, step after step. Then a level for each, then slices.
void Rounds::refine_class(std::size_t begin, std::size_t end, StepBudget& budget, RecordTable& records) {
  order_open(begin, end, 1, records);
  if (!order_.empty()) refine_once(kDeepSlice, false, budget.left() / 2 + 1, budget, records);
  std::uint64_t slice = kFirstSlice;
  for (bool by_level = true; budget.may_refine(); by_level = false) {
    order_open(begin, end, 0, records);
    if (order_.empty()) return;
    refine_once(slice, by_level, std::numeric_limits<std::uint64_t>::max(), budget, records);
    slice = by_level ? kExactSlice : std::min<std::uint64_t>(4 * slice, std::uint64_t{1} << 32);
  }
}

void Rounds::fold(RecordTable& records, std::span<const std::uint32_t> open, Step now) {
  for (const std::uint32_t index : open) forget_answer(records[index]);
  // In the order of parts, whatever the order of the schedule was.
  std::sort(tasks_.begin(), tasks_.end(), [](const Task& p, const Task& q) { return p.sequence < q.sequence; });
  for (const Task& task : tasks_) take_in(records[task.record], task.verdict, task.part_a, task.part_b);
  for (const std::uint32_t index : open) {
    if (records[index].verdict.answer != Answer::maybe) records[index].answered = now;
  }
}

void Rounds::answer_within(RecordTable& records, std::span<const std::uint32_t> open, Step now, StepBudget& budget) {
  for (const std::uint32_t index : open) forget_answer(records[index]);
  make_tasks(records, open);
  begin_tasks(budget, records);
  for (const Task& task : tasks_) {
    if (task.verdict.answer == Answer::yes) records[task.record].verdict.answer = Answer::yes;
  }
  for (std::size_t begin = 0; begin < tasks_.size() && budget.may_refine();) {
    std::size_t end = begin;
    while (end < tasks_.size() && tasks_[end].importance == tasks_[begin].importance) ++end;
    refine_class(begin, end, budget, records);
    begin = end;
  }
  queries_->give_back_all();
  fold(records, open, now);
}

}  // namespace orchard::runtime::detail
