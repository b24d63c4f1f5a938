#pragma once
#include "detector/front_pool.h"
#include "detector/query_pool.h"
#include "detector/step_budget.h"
#include "detector/sweep.h"

namespace orchard::runtime::detail {

// What a record knows before anything is asked: nobody's parts are near. And what two of its parts add to that.
void forget_answer(Record& record) noexcept;
void take_in(Record& record, const Verdict& verdict, std::uint32_t part_a, std::uint32_t part_b) noexcept;

// Answers records at one step.
class Rounds {
 public:
  Rounds(const Places& places, QueryPool& queries, const Executor& executor, std::size_t max_unfinished,
         FrontPool& fronts) noexcept
      : places_(&places), queries_(&queries), executor_(&executor), max_unfinished_(max_unfinished), fronts_(&fronts) {}

  // Every record's part pairs to their end. Returns the work.
  std::uint64_t answer_all(RecordTable& records, std::span<const std::uint32_t> open, Step now);
  // The same by whoever has more to do with each of `count` things: work(job, scratch), where answer() may be called,
  // for so many jobs, each with its part of them.
  std::size_t jobs(std::size_t count) const noexcept;
  template <typename Work>
  std::uint64_t answer_by(std::size_t jobs, Work&& work);
  void answer(std::uint32_t index, Record& record, Step now, QueryPool::Scratch& scratch) const noexcept;
  // Afterwards: gives the pairs fronts whose last searches were the most expensive.
  void give_fronts(RecordTable& records, Step now);
  // The same as far as the budget goes, in three parts: what is done in any case; what the budget allows; and what that
  // makes of the records. What is not answered has the answer maybe and is not Record::answered.
  void begin_within(RecordTable& records, std::span<const std::uint32_t> open, Step now);
  void answer_within(RecordTable& records, StepBudget& budget);
  void fold(RecordTable& records, std::span<const std::uint32_t> open, Step now);
  static bool sweeps(const RecordTable& records, std::span<const std::uint32_t> open) noexcept;  // there are
  // What happened between the step before and this one, for the records that can be swept.
  void sweep_all(RecordTable& records, std::span<const std::uint32_t> open, Step now, StepBudget& budget);
  std::size_t memory_bytes() const noexcept {
    return bytes_of(tasks_) + bytes_of(schedule_) + bytes_of(sorted_) + bytes_of(order_) + bytes_of(sweeps_);
  }

  void use(const Executor& executor) noexcept { executor_ = &executor; }

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
  static bool is_slow(Record& record, const PartPair& pair, Step now) noexcept;
  void place(const Record& record, std::uint32_t part_a, std::uint32_t part_b, PartPair& pair) const noexcept;
  static Verdict answer_again(Record& record, std::uint32_t guess, const PartPair& pair,
                              QueryPool::Scratch& scratch) noexcept;
  static Verdict answer_anew(Record& record, const PartPair& pair, QueryPool::Scratch& scratch) noexcept;
  static void note_search(std::uint32_t index, Record& record, std::uint64_t work,
                          QueryPool::Scratch& scratch) noexcept;
  void answer_coherently(std::uint32_t index, Record& record, Step now, QueryPool::Scratch& scratch) const noexcept;
  void answer_two_parts(Record& record, Step now, QueryPool::Scratch& scratch) const noexcept;
  static constexpr std::uint32_t kNoPart = 0xffffffffu;
  struct PartIndices {
    std::uint32_t a = kNoPart, b = kNoPart;
  };
  bool answer_others(Record& record, const PartIndices& but, PartPair& pair,
                     QueryPool::Scratch& scratch) const noexcept;
  void answer_parts(Record& record, Step now, QueryPool::Scratch& scratch) const noexcept;
  void sweep_one(Record& record, Step now, QueryPool::Scratch& scratch, std::uint64_t most) const noexcept;
  void make_tasks(RecordTable& records, std::span<const std::uint32_t> open, Step now);
  void sort_tasks(const RecordTable& records);
  void begin_one(Task& task, Record& record, QueryPool::Scratch& scratch) const noexcept;
  void decide(Task& task, Record& record, std::uint64_t most, QueryPool::Scratch& scratch) const noexcept;
  template <typename Piece>
  void once_each(std::span<const std::uint32_t> tasks, StepBudget& budget, RecordTable& records, Piece&& piece);
  void decide_class(std::size_t begin, std::size_t end, StepBudget& budget, RecordTable& records);
  void order_open(std::size_t begin, std::size_t end, const RecordTable& records);
  void refine_class(std::size_t begin, std::size_t end, StepBudget& budget, RecordTable& records);
  void refine_once(std::uint64_t slice, StepBudget& budget, RecordTable& records);
  void refine_one(Task& task, const Record& record, std::uint64_t slice, std::chrono::nanoseconds time) const noexcept;
  static constexpr std::size_t kJobsPerThread = 4;  // some pairs cost a hundred times what others do
  static constexpr std::size_t kMinPerJob = 8;
  template <typename Work>
  void in_parallel(std::size_t count, Work&& work) const;

  const Places* places_;
  QueryPool* queries_;
  const Executor* executor_;
  std::size_t max_unfinished_;
  FrontPool* fronts_;
  std::vector<Task> tasks_;                       // in the order of pairs, then of parts
  std::vector<std::uint32_t> schedule_, sorted_;  // of tasks
  std::vector<std::uint32_t> order_, sweeps_;
  std::size_t begun_ = 0;  // of schedule_
  Step now_ = -1;
  std::int64_t lead_ = 0;  // of the work on what begins
};

// The cutting depends on nothing but `count` and the executor's concurrency, and no answer on the cutting.
inline std::size_t Rounds::jobs(std::size_t count) const noexcept {
  const std::size_t wanted = executor_->run == nullptr ? 1 : executor_->concurrency * kJobsPerThread;
  return std::clamp<std::size_t>(std::min(wanted, queries_->jobs()), 1, count / kMinPerJob + 1);
}

// work(begin, end, scratch) for consecutive parts of 0 .. count - 1.
template <typename Work>
void Rounds::in_parallel(std::size_t count, Work&& work) const {
  const std::size_t among = jobs(count);
  auto job = [&](std::size_t index) {
    work(count * index / among, count * (index + 1) / among, queries_->scratch(index));
  };
  run_jobs(*executor_, among, job);
}

template <typename Work>
std::uint64_t Rounds::answer_by(std::size_t jobs, Work&& work) {
  for (std::size_t job = 0; job < queries_->jobs(); ++job) queries_->scratch(job).work = 0;
  auto one = [&](std::size_t job) { work(job, queries_->scratch(job)); };
  run_jobs(*executor_, jobs, one);
  std::uint64_t sum = 0;
  for (std::size_t job = 0; job < queries_->jobs(); ++job) sum += queries_->scratch(job).work;
  return sum;
}

}  // namespace orchard::runtime::detail
