#include <algorithm>
#include <array>

#include "collision/coherent_pair.h"
#include "collision/pair_query.h"
#include "detector/schedule_pairs.h"

// Within a budget: by class of importance, and there in the order of who has waited longest. At the same time
// each pair's answer is begun with what costs next to nothing and tells most pairs: spheres, roots, what the last step
// found, simple shapes; and those who need more go straight to their triangles, one after the other. As most take a few
// microseconds, a pair that takes more than kFirstSlice gives way, and is gone on with, by slices that grow, when every
// pair of the class has had a turn.
namespace orchard::runtime::detail {
namespace {

constexpr std::uint64_t kFirstSlice = 1024;       // tests; each further slice is four times as large
constexpr std::int64_t kBeginsShare = 16;         // of the work, to 1 for searches, until all have begun
constexpr std::size_t kAtOnce = 64;               // tasks, so that the turns depend on no number of threads
constexpr std::uint8_t kSearchesBeforeRoots = 4;  // of a pair that its roots have not told apart

// By one digit of 256, stable.
template <typename Digit>
void sort_by(std::vector<std::uint32_t>& tasks, std::vector<std::uint32_t>& sorted, Digit&& digit) {
  std::array<std::uint32_t, 257> begin{};
  for (const std::uint32_t task : tasks) ++begin[digit(task) + 1u];
  if (std::find(begin.begin(), begin.end(), tasks.size()) != begin.end()) return;  // all the same
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  sorted.resize(tasks.size());
  for (const std::uint32_t task : tasks) sorted[begin[digit(task)]++] = task;
  tasks.swap(sorted);
}

}  // namespace

// A task for each two parts, with what their spheres say: so much is known of every pair whatever the budget.
void PairScheduler::make_tasks(PairCache& records, std::span<const std::uint32_t> open, Step now) {
  const ShapePlacements& places = answerer_.places();
  tasks_.clear();
  for (const std::uint32_t index : open) {
    CachedPair& record = records[index];
    forget_answer(record);
    const std::uint32_t parts_a = places.parts(record.bodies.a), parts_b = places.parts(record.bodies.b);
    PartPair pair;
    if (is_half_space(record.bodies.b)) pair.half = places.half_space(record.bodies.b);
    for (std::uint32_t i = 0; i < parts_a; ++i) {
      places.place(record.bodies.a, i, pair.a);
      for (std::uint32_t j = 0; j < parts_b; ++j) {
        places.place(record.bodies.b, j, pair.b);
        Task& task = tasks_.emplace_back();
        task.record = index, task.part_a = i, task.part_b = j;
        task.simple = pair.simple();
        task.verdict = unasked(pair);
        task.done = task.verdict.answer == Answer::no;
        task.slow = record.coherent && PairAnswerer::is_slow(record, pair, now);
      }
    }
  }
}

void PairScheduler::sort_tasks(const PairCache& records) {
  schedule_.clear();
  for (std::uint32_t i = 0; i < tasks_.size(); ++i) {
    if (!tasks_[i].done) schedule_.push_back(i);
  }
  sort_by(schedule_, sorted_,
          [&](std::uint32_t task) { return 255 - std::min(records[tasks_[task].record].turn.waited, 255u); });
  sort_by(schedule_, sorted_, [&](std::uint32_t task) { return records[tasks_[task].record].turn.importance; });
}

// What can be told without a search.
void PairScheduler::begin_one(Task& task, CachedPair& record, QueryPool::Scratch& scratch) const noexcept {
  PartPair pair;
  PairQuery& narrow = query_of(scratch.workspace.narrow);
  const double bound = task.verdict.separation_bound;
  if (task.simple) {
    answerer_.place(record, task.part_a, task.part_b, pair);
    task.verdict = answer_exactly(narrow, pair, task.work);
    task.done = true;
    return;
  }
  task.work = kPairWork;
  const bool remembers = task.slow && CoherentPair::remembers(record.trees);
  // Of bodies of several parts, whose tasks may run at once, all have their roots asked.
  if (record.coherent && !remembers && record.turn.roots_wait > 0) {
    --record.turn.roots_wait;
    return;
  }
  answerer_.place(record, task.part_a, task.part_b, pair);
  Verdict known;
  if (remembers && CoherentPair::recall(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose(), known)) {
    task.verdict = solid_verdict(known, pair);
    task.done = true;
  } else {
    narrow.bind(pair.a.shape->prepared, pair.b.shape->prepared);
    narrow.start(pair.a.pose(), pair.b.pose());
    task.verdict = verdict_of(narrow, pair);
    task.done = narrow.finished();
    if (record.coherent) record.turn.roots_wait = task.done ? 0 : kSearchesBeforeRoots;
  }
  task.verdict.separation_bound = std::min(task.verdict.separation_bound, bound);
  task.verdict.work = task.work;
}

void PairScheduler::decide(Task& task, CachedPair& record, std::uint64_t most,
                           QueryPool::Scratch& scratch) const noexcept {
  PartPair pair;
  answerer_.place(record, task.part_a, task.part_b, pair);
  const double bound = task.verdict.separation_bound;
  PairQuery& narrow = query_of(scratch.workspace.narrow);
  Verdict verdict;
  if (task.slow) {
    verdict = CoherentPair::search(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose(), {most});
  } else {
    narrow.bind(pair.a.shape->prepared, pair.b.shape->prepared);
    verdict = collide(narrow, pair.a.pose(), pair.b.pose(), {most});
  }
  task.work = verdict.work;
  task.done = verdict.answer != Answer::maybe || narrow.finished();
  task.verdict = solid_verdict(verdict, pair);
  task.verdict.separation_bound = std::min(task.verdict.separation_bound, bound);
  task.verdict.work = kPairWork + task.work;
}

// piece(task, record, scratch) for each; budget.may_begin() says where the clock ends it.
template <typename Piece>
void PairScheduler::once_each(std::span<const std::uint32_t> tasks, StepBudget& budget, PairCache& records,
                              Piece&& piece) {
  const bool alone = world_.options.executor.run == nullptr;
  in_parallel(tasks.size(), [&](std::size_t begin, std::size_t end, QueryPool::Scratch& scratch) {
    for (std::size_t i = begin; i < end; ++i) {
      Task& task = tasks_[tasks[i]];
      task.work = 0;
      if (alone ? budget.may_begin() : !budget.late()) piece(task, records[task.record], scratch);
    }
  });
  for (const std::uint32_t index : tasks) {
    const Task& task = tasks_[index];
    budget.spend(task.work);
    if (task.verdict.answer == Answer::yes) records[task.record].verdict.answer = Answer::yes;
  }
}

// A turn for each of schedule_[begin, end), and meanwhile the beginning of all. What is done at once has its overshoot
// set aside, so that the budget holds.
void PairScheduler::decide_class(std::size_t begin, std::size_t end, StepBudget& budget, PairCache& records) {
  // What has been told meanwhile, of the task or of its bodies.
  const auto settled = [&](std::uint32_t task) {
    return tasks_[task].done || records[tasks_[task].record].verdict.answer == Answer::yes;
  };
  while (begin < end && budget.may_go_on()) {
    const std::uint64_t left = budget.left(), before = budget.spent();
    const bool begins = begun_ <= begin || (begun_ < schedule_.size() && lead_ <= 0);
    const std::uint64_t each = begins ? kSimplePairWork : kFirstSlice + kMaxOvershoot;
    std::size_t at_once = static_cast<std::size_t>(std::clamp<std::uint64_t>(left / each, 1, kAtOnce));
    order_.clear();
    if (begins) {
      for (; begun_ < schedule_.size() && order_.size() < at_once; ++begun_) {
        if (!settled(schedule_[begun_])) order_.push_back(schedule_[begun_]);
      }
      once_each(order_, budget, records,
                [&](Task& task, CachedPair& record, QueryPool::Scratch& scratch) { begin_one(task, record, scratch); });
      lead_ += static_cast<std::int64_t>(budget.spent() - before);
      continue;
    }
    // Until it is the turn of what begins.
    if (begun_ < schedule_.size())
      at_once = std::min<std::size_t>(at_once, static_cast<std::size_t>(lead_) / kFirstSlice + 1);
    for (; begin < std::min(end, begun_) && order_.size() < at_once; ++begin) {
      if (!settled(schedule_[begin])) order_.push_back(schedule_[begin]);
    }
    const std::uint64_t most = std::min(left, kFirstSlice);
    once_each(order_, budget, records, [&](Task& task, CachedPair& record, QueryPool::Scratch& scratch) {
      decide(task, record, most, scratch);
    });
    lead_ -= kBeginsShare * static_cast<std::int64_t>(budget.spent() - before);
  }
}

// What is still open of a class.
void PairScheduler::order_open(std::size_t begin, std::size_t end, const PairCache& records) {
  order_.clear();
  for (std::size_t i = begin; i < end; ++i) {
    Task& task = tasks_[schedule_[i]];
    if (task.done || task.simple || records[task.record].verdict.answer == Answer::yes) continue;
    if (task.query == nullptr && (task.query = queries_.take(world_.options.max_unfinished)) == nullptr) continue;
    order_.push_back(schedule_[i]);
  }
}

void PairScheduler::refine_class(std::size_t begin, std::size_t end, StepBudget& budget, PairCache& records) {
  std::uint64_t slice = 4 * kFirstSlice;
  while (budget.may_refine()) {
    order_open(begin, end, records);
    if (order_.empty()) return;
    refine_once(slice, budget, records);
    slice = std::min<std::uint64_t>(4 * slice, std::uint64_t{1} << 32);
  }
}

void PairScheduler::refine_one(Task& task, const CachedPair& record, std::uint64_t slice,
                               std::chrono::nanoseconds time) const noexcept {
  PartPair pair;
  answerer_.place(record, task.part_a, task.part_b, pair);
  PairQuery& query = *task.query;
  if (!task.started) {
    query.bind(pair.a.shape->prepared, pair.b.shape->prepared);
    query.start(pair.a.pose(), pair.b.pose());
    task.started = true;
  }
  const double bound = task.verdict.separation_bound;
  const std::uint64_t before = query.known().work;
  query.refine_exactly({slice, time});
  task.work = query.known().work - before;
  task.done = query.finished();
  task.verdict = verdict_of(query, pair);
  task.verdict.separation_bound = std::min(task.verdict.separation_bound, bound);
}

// One piece for each of order_; what may run at once has its overshoot set aside, so that the budget holds.
void PairScheduler::refine_once(std::uint64_t slice, StepBudget& budget, PairCache& records) {
  const bool alone = world_.options.executor.run == nullptr;
  for (std::size_t next = 0; next < order_.size();) {
    const std::uint64_t left = budget.left();
    if (left == 0 || !budget.may_refine()) return;
    const std::uint64_t at_once = std::min<std::uint64_t>(order_.size() - next, left / (slice + kMaxOvershoot));
    const auto count = static_cast<std::size_t>(std::max<std::uint64_t>(at_once, 1));
    const std::uint64_t piece = at_once > 0 ? slice : std::min(slice, left);
    in_parallel(count, [&](std::size_t from, std::size_t to, QueryPool::Scratch&) {
      for (std::size_t i = from; i < to; ++i) {
        Task& task = tasks_[order_[next + i]];
        task.work = 0;
        if (alone ? !budget.may_refine() : budget.late()) continue;
        refine_one(task, records[task.record], budget.piece(piece), budget.time_left());
        if (alone) budget.refined(task.work);
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      const Task& task = tasks_[order_[next + i]];
      budget.spend(task.work);
      if (task.verdict.answer == Answer::yes) records[task.record].verdict.answer = Answer::yes;
    }
    next += count;
  }
}

void PairScheduler::fold(PairCache& records, std::span<const std::uint32_t> open, Step now) {
  for (const std::uint32_t index : open) forget_answer(records[index]);
  for (const Task& task : tasks_) add(records[task.record], task.verdict, task.part_a, task.part_b);
  for (const std::uint32_t index : open) {
    if (records[index].verdict.answer != Answer::maybe) records[index].answered = now;
  }
}

void PairScheduler::begin_within(PairCache& records, std::span<const std::uint32_t> open, Step now) {
  make_tasks(records, open, now);
  sort_tasks(records);
  begun_ = 0;
  lead_ = 0;
}

void PairScheduler::answer_within(PairCache& records, StepBudget& budget) {
  const auto importance = [&](std::size_t i) { return records[tasks_[schedule_[i]].record].turn.importance; };
  for (std::size_t begin = 0; begin < schedule_.size();) {
    std::size_t end = begin;
    while (end < schedule_.size() && importance(end) == importance(begin)) ++end;
    decide_class(begin, end, budget, records);
    refine_class(begin, end, budget, records);
    begin = end;
  }
  queries_.give_back_all();
}

}  // namespace orchard::runtime::detail
