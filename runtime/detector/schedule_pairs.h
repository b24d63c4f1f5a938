#pragma once
#include "detector/answer_pairs.h"
#include "detector/step_budget.h"
#include "detector/world.h"

namespace orchard::runtime::detail {

// Schedule: which pairs of a step are answered when, by jobs, and within a budget in what order.
//
// Within a budget: by class of importance, and there in the order of who has waited longest. First each pair of parts
// gets what costs next to nothing and tells most of them: spheres, roots, what the last step found, simple shapes. A
// share of the budget is set aside for those that need more: each gets a search of its triangles, as far as kFirstSlice
// goes. As most take a few microseconds, those that have not ended then begin again, with slices that grow, when every
// pair of the class has had a turn.
class PairScheduler {
 public:
  explicit PairScheduler(const World& world) noexcept : world_(world), answerer_(world.places) {}

  // Before a step: a scratch for each job, with room for pairs of all shapes, and for sweeps if there are any, so that
  // no query allocates.
  void prepare();

  // use(i, scratch) for i = 0 .. count - 1, by jobs. Returns the work that the scratches count.
  template <typename Use>
  std::uint64_t each(std::size_t count, Use&& use);
  const PairAnswerer& answerer() const noexcept { return answerer_; }

  // Answers as far as the budget goes, in three parts: what is done in any case; what the budget allows; and what that
  // makes of the records. What is not answered has the answer maybe and is not CachedPair::answered.
  void begin_within(PairCache& records, std::span<const std::uint32_t> open);
  void answer_within(PairCache& records, StepBudget& budget);
  void fold(PairCache& records, std::span<const std::uint32_t> open, Step now);
  // What happened between the step before and this one, for the records that can be swept.
  void sweep_within(PairCache& records, std::span<const std::uint32_t> open, Step now, StepBudget& budget);

  Workspace* workspace() noexcept { return scratches_.empty() ? nullptr : &scratches_[0]->workspace; }
  std::size_t memory_bytes() const noexcept;

 private:
  struct Task {
    std::uint32_t record = 0, part_a = 0, part_b = 0;
    bool done = false, simple = false;
    std::uint64_t work = 0;  // of the last piece
    Verdict verdict;
  };
  void begin_one(Task& task, CachedPair& record, AnswerScratch& scratch) const noexcept;
  void search_one(Task& task, CachedPair& record, const Budget& most, bool is_first,
                  AnswerScratch& scratch) const noexcept;
  bool give_turns(std::size_t begin, std::size_t end, std::uint64_t slice, StepBudget& budget, PairCache& records);

  const World& world_;
  PairAnswerer answerer_;
  std::vector<std::unique_ptr<AnswerScratch>> scratches_;
  std::size_t seen_shapes_ = 0;
  bool sweeps_ = false;
  PreparedTree deepest_;                 // of all shapes: a query that has been bound to it allocates for no other
  std::vector<Task> tasks_;              // in the order of pairs, then of parts
  std::vector<std::uint64_t> schedule_;  // of tasks: their importance, how long they have waited, and their index
  std::vector<std::uint32_t> order_;     // of the tasks that run at once
};

// The cutting depends on nothing but `count` and the executor's concurrency, and no answer on the cutting.
template <typename Use>
std::uint64_t PairScheduler::each(std::size_t count, Use&& use) {
  constexpr std::size_t kMinPerJob = 8;  // some pairs cost a hundred times what others do
  const Executor& executor = world_.options.executor;
  const std::size_t jobs = executor.run == nullptr ? 1 : std::min(scratches_.size(), count / kMinPerJob + 1);
  auto one = [&](std::size_t job) {
    AnswerScratch& scratch = *scratches_[job];
    scratch.work = 0;
    const std::size_t end = count * (job + 1) / jobs;
    for (std::size_t i = count * job / jobs; i < end; ++i) use(i, scratch);
  };
  run_jobs(executor, jobs, one);
  std::uint64_t work = 0;
  for (std::size_t job = 0; job < jobs; ++job) work += scratches_[job]->work;
  return work;
}

}  // namespace orchard::runtime::detail
