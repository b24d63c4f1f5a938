#include "detector/schedule_pairs.h"

#include <algorithm>

#include "collision/coherent_pair.h"
#include "collision/pair_query.h"
#include "collision/workspace_scratch.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::uint64_t kFirstSlice = 1024;       // tests; each further slice is four times as large
constexpr std::uint64_t kSearchShare = 8;         // one part in so many of the budget is set aside for searches
constexpr std::uint8_t kSearchesBeforeRoots = 4;  // for a pair whose roots did not separate it
constexpr std::uint64_t kTask = 0xffffffffu;      // the bits of a schedule entry that are the task's index
constexpr std::size_t kAtOnce = 64;               // tasks; fixed, so that turns do not depend on the threads

}  // namespace

void PairScheduler::prepare() {
  constexpr std::size_t kJobsPerThread = 4;
  const Executor& executor = world_.options.executor;
  const std::size_t jobs =
      executor.run == nullptr ? 1 : std::max<std::size_t>(1, executor.concurrency) * kJobsPerThread;
  const bool more = seen_shapes_ < world_.shapes.size() || (world_.any.continuous && !sweeps_);
  sweeps_ = sweeps_ || world_.any.continuous;
  for (; seen_shapes_ < world_.shapes.size(); ++seen_shapes_) {
    const Shape& shape = world_.shapes[static_cast<ShapeId>(seen_shapes_)];
    if (deepest_.tree.blocks.empty() || deepest_.tree.triangle_tree_depth <= shape.tree.triangle_tree_depth)
      deepest_ = shape.prepared;
  }
  const std::size_t before = scratches_.size();
  while (scratches_.size() < jobs) scratches_.push_back(std::make_unique<AnswerScratch>());
  if (deepest_.tree.blocks.empty()) return;
  for (std::size_t i = more ? 0 : before; i < scratches_.size(); ++i) {
    Workspace& workspace = scratches_[i]->workspace;
    workspace.narrow.bind(deepest_, deepest_);
    workspace.distance.bind(deepest_, deepest_);
    Workspace::Scratch* const scratch = sweeps_ ? workspace.scratch() : nullptr;
    if (scratch != nullptr) scratch->timed.reserve(deepest_.tree, deepest_.tree);
  }
}

std::size_t PairScheduler::memory_bytes() const noexcept {
  constexpr std::size_t kStackEntry = 48;
  const std::size_t pairs = std::size_t{kBlockWidth} * (2 * deepest_.tree.triangle_tree_depth + 1) + 1;
  const std::size_t sweeps = sweeps_ ? sizeof(Workspace::Scratch) + pairs * sizeof(Workspace::Scratch::TimedPair) : 0;
  return scratches_.size() * (sizeof(AnswerScratch) + 2 * pairs * kStackEntry + sweeps) +
         bytes_of(tasks_, schedule_, order_);
}

// Makes a task for each two parts, with what their spheres say about them; this much is known of every pair, whatever
// the budget. The tasks that spheres do not decide are then sorted by importance, by the number of steps that their
// pairs have waited, longest first, and by index.
void PairScheduler::begin_within(PairCache& records, std::span<const std::uint32_t> open) {
  const ShapePlacements& places = world_.places;
  tasks_.clear(), schedule_.clear();
  for (const std::uint32_t index : open) {
    CachedPair& record = records[index];
    forget_answer(record);
    const std::uint32_t parts_a = places.parts(record.bodies.a), parts_b = places.parts(record.bodies.b);
    PartPair pair;
    for (std::uint32_t i = 0; i < parts_a; ++i) {
      for (std::uint32_t j = 0; j < parts_b; ++j) {
        answerer_.place(record, i, j, pair);
        Task& task = tasks_.emplace_back();
        task.record = index, task.part_a = i, task.part_b = j;
        task.simple = pair.simple();
        task.verdict = unasked(pair);
        task.done = task.verdict.answer == Answer::no;
        const std::uint64_t waited = std::min(record.turn.waited, 255u), importance = record.turn.importance;
        if (!task.done) schedule_.push_back(importance << 40 | (255 - waited) << 32 | (tasks_.size() - 1));
      }
    }
  }
  std::sort(schedule_.begin(), schedule_.end());
}

void PairScheduler::answer_within(PairCache& records, StepBudget& budget) {
  const StepBudget::Part for_searches = budget.part(kSearchShare);
  budget.set_aside(for_searches);
  give_turns(0, schedule_.size(), 0, budget, records);
  budget.give_back(for_searches);
  for (std::size_t begin = 0; begin < schedule_.size();) {
    std::size_t end = begin;
    while (end < schedule_.size() && schedule_[end] >> 40 == schedule_[begin] >> 40) ++end;
    std::uint64_t slice = kFirstSlice;
    while (give_turns(begin, end, slice, budget, records)) slice = std::min<std::uint64_t>(4 * slice, 1ull << 32);
    begin = end;
  }
}

// Gives a turn to each open task of schedule_[begin, end): a search of at most `slice` tests or, if `slice` is 0, the
// tests that need no search. No more tasks run at the same time than fit into what is left, each with its overshoot, so
// that the budget holds. Returns true if every task has had its turn and some are still open.
bool PairScheduler::give_turns(std::size_t begin, std::size_t end, std::uint64_t slice, StepBudget& budget,
                               PairCache& records) {
  const bool alone = world_.options.executor.run == nullptr, searches = slice > 0;
  const std::uint64_t most_of_one = !searches ? kSimplePairWork : slice + kMaxOvershoot;
  const auto is_open = [&](std::uint64_t turn) {
    const Task& task = tasks_[turn & kTask];
    return !task.done && records[task.record].verdict.answer != Answer::yes;
  };
  std::size_t next = begin;
  while (next < end && (searches ? budget.may_refine() : budget.may_go_on())) {
    const std::uint64_t left = budget.left(), most = std::min(left, slice);
    const std::size_t at_once = static_cast<std::size_t>(std::clamp<std::uint64_t>(left / most_of_one, 1, kAtOnce));
    for (order_.clear(); next < end && order_.size() < at_once; ++next) {
      if (is_open(schedule_[next])) order_.push_back(static_cast<std::uint32_t>(schedule_[next] & kTask));
    }
    each(order_.size(), [&](std::size_t i, AnswerScratch& scratch) {
      Task& task = tasks_[order_[i]];
      CachedPair& record = records[task.record];
      task.work = 0;
      if (alone ? !(searches ? budget.may_refine() : budget.may_begin()) : budget.late()) return;
      if (!searches) return begin_one(task, record, scratch);
      // The first search is short, so neither the clock limits it nor, in a replay, the place at which another run was
      // cut.
      const Budget within = slice == kFirstSlice ? Budget{most} : Budget{budget.piece(most), budget.time_left()};
      search_one(task, record, within, slice == kFirstSlice, scratch);
      if (alone) budget.refined(task.work);
    });
    for (const std::uint32_t index : order_) {
      const Task& task = tasks_[index];
      budget.spend(task.work);
      if (task.verdict.answer == Answer::yes) records[task.record].verdict.answer = Answer::yes;
    }
  }
  const auto all = std::span(std::as_const(schedule_)).subspan(begin, end - begin);
  return next == end && std::any_of(all.begin(), all.end(), is_open);
}

// Does the tests that need no search: simple shapes, what the last step found, or the roots of both trees.
void PairScheduler::begin_one(Task& task, CachedPair& record, AnswerScratch& scratch) const noexcept {
  if (task.simple) return search_one(task, record, {}, true, scratch);
  task.work = kPairWork;
  const bool remembers = record.coherent && CoherentPair::remembers(record.trees);
  // Only pairs of bodies of one part skip the roots. The tasks of other pairs share a record and may run at the same
  // time.
  if (record.coherent && !remembers && record.turn.roots_wait > 0) {
    --record.turn.roots_wait;
    return;
  }
  PartPair pair;
  answerer_.place(record, task.part_a, task.part_b, pair);
  const double bound = task.verdict.separation_bound;
  Verdict known;
  if (remembers && CoherentPair(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose()).recall(known)) {
    task.verdict = known;
    task.done = true;
  } else {
    PairQuery& narrow = query_of(scratch.workspace.narrow);
    narrow.bind(pair.a.shape->prepared, pair.b.shape->prepared);
    narrow.start(pair.a.pose(), pair.b.pose());
    task.verdict = narrow.verdict();
    task.done = narrow.finished();
    if (record.coherent) record.turn.roots_wait = task.done ? 0 : kSearchesBeforeRoots;
  }
  make_solid(task.verdict, pair);
  task.verdict.separation_bound = std::min(task.verdict.separation_bound, bound);
  task.verdict.work = task.work;
}

// The first search of a pair of trees begins with what the last step found. Each further slice begins again at the
// roots, which costs a third more than continuing would, for the few pairs that need several slices.
void PairScheduler::search_one(Task& task, CachedPair& record, const Budget& most, bool is_first,
                               AnswerScratch& scratch) const noexcept {
  PartPair pair;
  answerer_.place(record, task.part_a, task.part_b, pair);
  PairQuery& narrow = query_of(scratch.workspace.narrow);
  if (task.simple) {
    task.verdict = answer_exactly(narrow, pair, task.work);
    task.done = true;
    return;
  }
  const double bound = task.verdict.separation_bound;
  if (record.coherent && is_first) {
    task.verdict = CoherentPair(scratch.workspace, record.trees, pair.a.pose(), pair.b.pose()).search(most);
  } else {
    narrow.bind(pair.a.shape->prepared, pair.b.shape->prepared);
    task.verdict = collide(narrow, pair.a.pose(), pair.b.pose(), most);
  }
  task.work = task.verdict.work;
  task.done = task.verdict.answer != Answer::maybe || narrow.finished();
  make_solid(task.verdict, pair);
  task.verdict.separation_bound = std::min(task.verdict.separation_bound, bound);
  task.verdict.work = kPairWork + task.work;
}

void PairScheduler::fold(PairCache& records, std::span<const std::uint32_t> open, Step now) {
  for (const std::uint32_t index : open) forget_answer(records[index]);
  for (const Task& task : tasks_) add(records[task.record], task.verdict, task.part_a, task.part_b);
  for (const std::uint32_t index : open) {
    if (records[index].verdict.answer != Answer::maybe) records[index].answered = now;
  }
}

void PairScheduler::sweep_within(PairCache& records, std::span<const std::uint32_t> open, Step now,
                                 StepBudget& budget) {
  std::uint64_t swept = 0;
  for (const std::uint32_t index : open) {
    CachedPair& record = records[index];
    if (record.sweep.unseen || (record.sweep.possible && !budget.may_sweep(swept)))
      leave_open(record);
    else if (record.sweep.possible) {
      scratches_[0]->work = 0;
      answerer_.sweep(record, now, *scratches_[0], budget.left());
      budget.spend(scratches_[0]->work);
      ++swept;
    }
  }
}

}  // namespace orchard::runtime::detail
