#pragma once
#include <atomic>
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

// Calls ask(job, i) once for each i < count, on as many threads as the executor has, and returns when all calls have
// returned. At most `jobs` jobs run at once; job j, below `jobs`, makes its calls one after the other, so that it may
// use the j-th of some workspaces. `ask` must not throw. Allocates nothing.
//   share_among(pool, workspaces.size(), pairs.size(), [&](std::size_t job, std::size_t i) {
//     verdicts[i] = collide(workspaces[job], pairs[i], a[i], b[i]);
//   });
template <typename Ask>
void share_among(const Executor& executor, std::size_t jobs, std::size_t count, const Ask& ask) noexcept {
  constexpr std::size_t portion = 16;  // questions that a job takes at a time
  std::atomic<std::size_t> next{0};
  auto work = [&](std::size_t job) {
    for (;;) {
      const std::size_t begin = next.fetch_add(portion, std::memory_order_relaxed);
      if (begin >= count) return;
      for (std::size_t i = begin; i < count && i < begin + portion; ++i) ask(job, i);
    }
  };
  const std::size_t portions = (count + portion - 1) / portion;
  run_jobs(executor, jobs < portions ? jobs : portions, work);
}

}  // namespace orchard::runtime
