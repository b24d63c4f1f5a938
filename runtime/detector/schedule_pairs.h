#pragma once
#include "detector/answer_pairs.h"
#include "detector/step_budget.h"
#include "detector/world.h"

namespace orchard::runtime::detail {

// The stage "schedule" of a step: divides the pairs among jobs and, within a budget, decides in which order they are
// answered. That order is by class of importance, and in a class by the number of steps that a pair has waited. There
// are three passes:
//   1. Each pair of parts gets the cheap tests, which decide most pairs: spheres, roots, what the last step found,
//      simple shapes. A share of the budget is set aside for the other passes.
//   2. In each class, each pair of parts that is still open gets a search of its triangles with a limit of kFirstSlice
//      tests. Most searches end within it, in a few microseconds.
//   3. When every pair of the class has had its turn, the searches that did not end begin again, with limits that grow.
class PairScheduler {
 public:
  explicit PairScheduler(const World& world) noexcept : world_(world), answerer_(world.places) {}

  // Allocates a scratch for each job, with room for pairs of all shapes and, if there are continuous bodies, for
  // sweeps. Call it before each step; then no query allocates.
  void prepare();

  // Calls use(i, scratch) for i = 0 .. count - 1, by jobs. Returns the sum of the work that the scratches have counted.
  template <typename Use>
  std::uint64_t each(std::size_t count, Use&& use);
  const PairAnswerer& answerer() const noexcept { return answerer_; }

  // These three functions, called in this order, answer the pairs `open` as far as the budget goes. The first one tests
  // the spheres of all parts, whatever the budget.
  void begin_within(PairCache& records, std::span<const std::uint32_t> open);
  // Runs the three passes until the budget is spent.
  void answer_within(PairCache& records, StepBudget& budget);
  // Combines the verdicts of parts to the answers of the records. A pair without a certain answer gets "maybe", and its
  // CachedPair::answered stays as it is.
  void fold(PairCache& records, std::span<const std::uint32_t> open, Step now);
  // Sweeps from the step before to this one, for the records that can be swept, until the budget is spent. Where a
  // sweep is missing, the answer becomes "maybe", unless the bodies touch.
  void sweep_within(PairCache& records, std::span<const std::uint32_t> open, Step now, StepBudget& budget);

  // Returns the workspace of the first job, or null before prepare().
  Workspace* workspace() noexcept { return scratches_.empty() ? nullptr : &scratches_[0]->workspace; }
  std::size_t memory_bytes() const noexcept;

 private:
  struct Task {  // two parts that are to be tested
    std::uint32_t record = 0, part_a = 0, part_b = 0;
    bool done = false, simple = false;
    std::uint64_t work = 0;  // of its last turn
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
  PreparedTree deepest_;                 // the tree with the deepest triangle BVH; queries bound to it have enough room
  std::vector<Task> tasks_;              // in the order of pairs, then of parts
  std::vector<std::uint64_t> schedule_;  // a sort key for each open task: importance, steps waited, index of the task
  std::vector<std::uint32_t> order_;     // the indices of the tasks that run at the same time
};

// The division into jobs depends only on `count` and the executor's concurrency, and no answer depends on the division.
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
