#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>

// Budgets of calls, and executors of parallel work.
namespace orchard::runtime {

// Limits of one call. The call stops at the first limit that it reaches. The unit of work, and the amount by which a
// call may exceed its budget, depend on the query: NarrowPhase counts tests of nodes and triangles, BroadPhase counts
// motions that it asks for, and Detector counts both.
struct Budget {
  // The maximum work, in units of the query.
  std::uint64_t work = std::numeric_limits<std::uint64_t>::max();
  std::chrono::nanoseconds time = std::chrono::nanoseconds::max();  // The time limit, by the steady clock.

  bool limited() const noexcept { return work != Budget{}.work || time != Budget{}.time; }
  friend bool operator==(const Budget&, const Budget&) = default;
};

/// How the run-time's batches use more than one processor: a function of the caller's that runs numbered jobs, on the
/// threads of a pool that the caller owns. orchard itself never starts a thread, and without such a function every
/// batch is serial. The answers are the same either way.
struct Executor {
  /// One job of a batch. `data` is the argument of `run`, and `index` is 0 .. count - 1. A job must not throw.
  using Job = void (*)(void* data, std::size_t index);

  /// Calls job(data, i) once for each i < count, in any order and on any threads, and returns when all calls have
  /// returned. Their effects are visible to the caller of `run` from then on. Null: the jobs run here, in order.
  void (*run)(void* context, std::size_t count, Job job, void* data) = nullptr;

  /// The first argument of `run`, for example the caller's pool.
  void* context = nullptr;

  /// How many jobs may run at once, at least 1: work is cut into at least this many parts. It changes the cutting only,
  /// never an answer.
  std::size_t concurrency = 1;
};

/// Runs jobs 0 .. count - 1 of `work`, a callable that takes the index, and returns when all are done. Allocates
/// nothing.
template <typename Work>
void run_jobs(const Executor& executor, std::size_t count, Work& work) {
  if (executor.run == nullptr || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  executor.run(
      executor.context, count, [](void* data, std::size_t index) { (*static_cast<Work*>(data))(index); }, &work);
}

}  // namespace orchard::runtime
