#pragma once
#include "detector/answer_pairs.h"
#include "detector/step_budget.h"
#include "detector/world.h"

namespace orchard::runtime::detail {

// Schedule: which pairs of a step are answered when, by jobs, and within a budget in what order.
class PairScheduler {
 public:
  explicit PairScheduler(const World& world) noexcept : world_(world), answerer_(world.places) {}

  void prepare();  // before a step: room for all shapes and threads

  // Every pair to its end. Returns the work.
  std::uint64_t answer_all(PairCache& records, std::span<const std::uint32_t> open, Step now);
  // The same for a caller that does more with each of `count` things: work(job, scratch), where answer() may be called,
  // for so many jobs, each with its part of them.
  std::size_t jobs(std::size_t count) const noexcept;
  template <typename Work>
  std::uint64_t answer_by(std::size_t jobs, Work&& work);
  void answer(CachedPair& record, Step now, QueryPool::Scratch& scratch) const noexcept {
    answerer_.answer(record, now, scratch);
  }
  // The same as far as the budget goes, in three parts: what is done in any case; what the budget allows; and what that
  // makes of the records. What is not answered has the answer maybe and is not CachedPair::answered.
  void begin_within(PairCache& records, std::span<const std::uint32_t> open, Step now);
  void answer_within(PairCache& records, StepBudget& budget);
  void fold(PairCache& records, std::span<const std::uint32_t> open, Step now);
  static bool sweeps(const PairCache& records, std::span<const std::uint32_t> open) noexcept;  // there are
  // What happened between the step before and this one, for the records that can be swept.
  void sweep_all(PairCache& records, std::span<const std::uint32_t> open, Step now, StepBudget& budget);

  Workspace* workspace() noexcept { return queries_.jobs() == 0 ? nullptr : &queries_.scratch(0).workspace; }
  std::size_t memory_bytes() const noexcept {
    return queries_.memory_bytes() + bytes_of(tasks_, schedule_, sorted_, order_, sweeps_);
  }

 private:
  struct Task {
    std::uint32_t record = 0, part_a = 0, part_b = 0;
    bool done = false, simple = false;
    bool slow = false;     // what the last step found may be of use
    bool started = false;  // `query` has been
    PairQuery* query = nullptr;
    std::uint64_t work = 0;  // of the last piece
    Verdict verdict;
  };
  void make_tasks(PairCache& records, std::span<const std::uint32_t> open, Step now);
  void sort_tasks(const PairCache& records);
  void begin_one(Task& task, CachedPair& record, QueryPool::Scratch& scratch) const noexcept;
  void decide(Task& task, CachedPair& record, std::uint64_t most, QueryPool::Scratch& scratch) const noexcept;
  template <typename Piece>
  void once_each(std::span<const std::uint32_t> tasks, StepBudget& budget, PairCache& records, Piece&& piece);
  void decide_class(std::size_t begin, std::size_t end, StepBudget& budget, PairCache& records);
  void order_open(std::size_t begin, std::size_t end, const PairCache& records);
  void refine_class(std::size_t begin, std::size_t end, StepBudget& budget, PairCache& records);
  void refine_once(std::uint64_t slice, StepBudget& budget, PairCache& records);
  void refine_one(Task& task, const CachedPair& record, std::uint64_t slice,
                  std::chrono::nanoseconds time) const noexcept;
  // work(begin, end, scratch) for consecutive parts of 0 .. count - 1.
  template <typename Work>
  void in_parallel(std::size_t count, Work&& work);

  const World& world_;
  PairAnswerer answerer_;
  QueryPool queries_;
  std::vector<Task> tasks_;                       // in the order of pairs, then of parts
  std::vector<std::uint32_t> schedule_, sorted_;  // of tasks
  std::vector<std::uint32_t> order_, sweeps_;
  std::size_t begun_ = 0;  // of schedule_
  std::int64_t lead_ = 0;  // of the work on what begins
};

template <typename Work>
void PairScheduler::in_parallel(std::size_t count, Work&& work) {
  const std::size_t among = jobs(count);
  auto job = [&](std::size_t index) {
    work(count * index / among, count * (index + 1) / among, queries_.scratch(index));
  };
  run_jobs(world_.options.executor, among, job);
}

template <typename Work>
std::uint64_t PairScheduler::answer_by(std::size_t jobs, Work&& work) {
  for (std::size_t job = 0; job < queries_.jobs(); ++job) queries_.scratch(job).work = 0;
  auto one = [&](std::size_t job) { work(job, queries_.scratch(job)); };
  run_jobs(world_.options.executor, jobs, one);
  std::uint64_t sum = 0;
  for (std::size_t job = 0; job < queries_.jobs(); ++job) sum += queries_.scratch(job).work;
  return sum;
}

}  // namespace orchard::runtime::detail
