#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>

#include "orchard/runtime/execution.h"

namespace orchard::runtime {

// ask(job, i) for i < count: at most `jobs` jobs at once, each of which takes the next few questions until none is
// left.
template <typename Ask>
void share_among(const Executor& executor, std::size_t jobs, std::size_t count, const Ask& ask) noexcept {
  constexpr std::size_t portion = 16;
  std::atomic<std::size_t> next{0};
  auto work = [&](std::size_t job) {
    for (;;) {
      const std::size_t begin = next.fetch_add(portion, std::memory_order_relaxed);
      if (begin >= count) return;
      const std::size_t end = std::min(count, begin + portion);
      for (std::size_t i = begin; i < end; ++i) ask(job, i);
    }
  };
  run_jobs(executor, std::min(jobs, (count + portion - 1) / portion), work);
}

}  // namespace orchard::runtime
