#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "orchard/runtime/execution.h"

namespace orchard::runtime::test {

// A pool as an application might have one: the caller's thread works, too, and threads without work look for some for a
// while before they sleep, since waking them takes as long as a small round of jobs.
class ThreadPool {
 public:
  using Duration = std::chrono::microseconds;

  // awake: how long threads look for work before they sleep.
  explicit ThreadPool(std::size_t threads, Duration awake = Duration(50)) : awake_(awake) {
    for (std::size_t i = 1; i < threads; ++i) threads_.emplace_back([this] { wait_for_work(); });
  }
  ~ThreadPool() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  Executor executor() { return {&ThreadPool::run, this, threads_.size() + 1}; }

 private:
  static void run(void* context, std::size_t count, Executor::Job job, void* data) {
    auto* const pool = static_cast<ThreadPool*>(context);
    pool->job_ = job, pool->data_ = data, pool->count_ = count;
    pool->next_ = 0;
    pool->busy_ = pool->threads_.size();
    {
      const std::lock_guard lock(pool->mutex_);
      ++pool->round_;
    }
    pool->wake_.notify_all();
    pool->work();
    pool->wait_until(pool->done_, [pool] { return pool->busy_ == 0; });
  }

  void work() {
    for (std::size_t i = next_++; i < count_; i = next_++) job_(data_, i);
  }

  // What makes it true is followed by a notification, under the mutex or after it was free.
  template <class Condition>
  void wait_until(std::condition_variable& notified, const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + awake_;
    do {
      if (condition()) return;
      std::this_thread::yield();
    } while (std::chrono::steady_clock::now() < end);
    std::unique_lock lock(mutex_);
    notified.wait(lock, condition);
  }

  void wait_for_work() {
    std::uint64_t seen = 0;
    for (;;) {
      wait_until(wake_, [&] { return stopping_ || round_ != seen; });
      if (stopping_) return;
      seen = round_;
      work();
      if (--busy_ > 0) continue;
      const std::lock_guard lock(mutex_);
      done_.notify_one();
    }
  }

  const Duration awake_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::vector<std::thread> threads_;
  Executor::Job job_ = nullptr;
  void* data_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_{0}, busy_{0};
  std::atomic<std::uint64_t> round_{0};
  std::atomic<bool> stopping_{false};
};

}  // namespace orchard::runtime::test
