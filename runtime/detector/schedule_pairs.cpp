#include "detector/schedule_pairs.h"

#include <algorithm>

namespace orchard::runtime::detail {

void PairScheduler::prepare() {
  const Executor& executor = world_.options.executor;
  queries_.prepare(world_.shapes, world_.shapes.size(),
                   executor.run == nullptr ? 1 : std::max<std::size_t>(1, executor.concurrency) * 4,
                   world_.any.continuous);
}

// The cutting depends on nothing but `count` and the executor's concurrency, and no answer on the cutting.
std::size_t PairScheduler::jobs(std::size_t count) const noexcept {
  constexpr std::size_t kJobsPerThread = 4, kMinPerJob = 8;  // some pairs cost a hundred times what others do
  const Executor& executor = world_.options.executor;
  const std::size_t wanted = executor.run == nullptr ? 1 : executor.concurrency * kJobsPerThread;
  return std::clamp<std::size_t>(std::min(wanted, queries_.jobs()), 1, count / kMinPerJob + 1);
}

std::uint64_t PairScheduler::answer_all(PairCache& records, std::span<const std::uint32_t> open, Step now) {
  const std::size_t among = jobs(open.size());
  return answer_by(among, [&](std::size_t job, QueryPool::Scratch& scratch) {
    const std::size_t end = open.size() * (job + 1) / among;
    for (std::size_t i = open.size() * job / among; i < end; ++i) {  // what a pair needs is all over memory
      constexpr std::size_t kRecord = 6, kBodies = 4;                // pairs ahead
      if (i + kRecord < end) prefetch_all(records[open[i + kRecord]]);
      if (i + kBodies < end) answerer_.places().prefetch_bodies(records[open[i + kBodies]].bodies);
      answerer_.answer(records[open[i]], now, scratch);
    }
  });
}

bool PairScheduler::sweeps(const PairCache& records, std::span<const std::uint32_t> open) noexcept {
  return std::any_of(open.begin(), open.end(), [&](std::uint32_t index) { return records[index].sweep.possible; });
}

void PairScheduler::sweep_all(PairCache& records, std::span<const std::uint32_t> open, Step now, StepBudget& budget) {
  sweeps_.clear();
  for (const std::uint32_t index : open) {
    if (records[index].sweep.possible) sweeps_.push_back(index);
    if (records[index].sweep.unseen) leave_open(records[index]);
  }
  if (sweeps_.empty()) return;
  std::size_t done = 0;
  while (done < sweeps_.size() && budget.may_sweep(done)) {
    const std::size_t count = budget.limited() ? 1 : sweeps_.size() - done;
    const std::uint64_t most = budget.left();
    for (std::size_t job = 0; job < queries_.jobs(); ++job) queries_.scratch(job).work = 0;
    in_parallel(count, [&](std::size_t begin, std::size_t end, QueryPool::Scratch& scratch) {
      for (std::size_t i = begin; i < end; ++i) answerer_.sweep(records[sweeps_[done + i]], now, scratch, most);
    });
    for (std::size_t job = 0; job < queries_.jobs(); ++job) budget.spend(queries_.scratch(job).work);
    done += count;
  }
  for (; done < sweeps_.size(); ++done) leave_open(records[sweeps_[done]]);
}

}  // namespace orchard::runtime::detail
