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

  // Whether there is a limit.
  bool limited() const noexcept { return work != Budget{}.work || time != Budget{}.time; }
  friend bool operator==(const Budget&, const Budget&) = default;
};

// Runs the jobs of a batch on threads of the application, for example those of its thread pool. orchard never starts a
// thread; without an executor, the jobs of a batch run one after the other. The answers are the same either way.
struct Executor {
  // One job of a batch. `data` is the argument of `run`, and `index` is 0 .. count - 1. A job must not throw.
  using Job = void (*)(void* data, std::size_t index);

  // A function of the application. It calls job(data, i) once for each i < count, in any order and on any threads, and
  // returns when all calls have returned; their effects are then visible to the caller of `run`. If it is null, the
  // jobs run in the calling thread, in ascending order.
  void (*run)(void* context, std::size_t count, Job job, void* data) = nullptr;

  // The first argument of `run`, for example the thread pool.
  void* context = nullptr;

  // The number of jobs that may run at once, at least 1. The work is divided into at least this many parts; the answers
  // do not depend on it.
  std::size_t concurrency = 1;
};

// Calls work(i) for each i < count by the executor, and returns when all calls have returned. Allocates nothing.
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
