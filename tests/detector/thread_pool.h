#pragma once
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "orchard/runtime/executor.h"

namespace orchard::runtime::test {

// A pool as an application might have one. The caller's thread works, too.
class ThreadPool {
 public:
  explicit ThreadPool(std::size_t threads) {
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
    {
      const std::lock_guard lock(pool->mutex_);
      pool->job_ = job, pool->data_ = data, pool->count_ = count;
      pool->next_ = 0;
      pool->busy_ = pool->threads_.size();
      ++pool->round_;
    }
    pool->wake_.notify_all();
    pool->work();
    std::unique_lock lock(pool->mutex_);
    pool->done_.wait(lock, [pool] { return pool->busy_ == 0; });
  }

  void work() {
    for (std::size_t i = next_++; i < count_; i = next_++) job_(data_, i);
  }

  void wait_for_work() {
    std::uint64_t seen = 0;
    for (;;) {
      {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [&] { return stopping_ || round_ != seen; });
        if (stopping_) return;
        seen = round_;
      }
      work();
      const std::lock_guard lock(mutex_);
      if (--busy_ == 0) done_.notify_one();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::vector<std::thread> threads_;
  Executor::Job job_ = nullptr;
  void* data_ = nullptr;
  std::size_t count_ = 0, busy_ = 0;
  std::atomic<std::size_t> next_{0};
  std::uint64_t round_ = 0;
  bool stopping_ = false;
};

}  // namespace orchard::runtime::test
