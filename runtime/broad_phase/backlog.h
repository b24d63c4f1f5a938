#pragma once
#include <deque>

#include "broad_phase/timing_wheel.h"

namespace orchard::runtime::detail {

// Bodies or pairs in the order in which they came.
template <typename T>
class WorkQueue {
 public:
  bool empty() const noexcept { return first_ == all_.size(); }
  std::size_t size() const noexcept { return all_.size() - first_; }
  void push(const T& one) { all_.push_back(one); }
  const T& front() const noexcept { return all_[first_]; }
  T pop() noexcept {
    const T one = all_[first_++];
    if (2 * first_ > all_.size()) forget_taken();
    return one;
  }
  void move_to(std::vector<T>& to) {  // the end of it
    to.insert(to.end(), all_.begin() + static_cast<std::ptrdiff_t>(first_), all_.end());
    all_.clear();
    first_ = tidied_ = 0;
  }
  // Drops what is of no use any more, once the queue has doubled: little work for each, and no endless growth.
  template <typename Useful>
  void tidy(const Useful& useful) {
    constexpr std::size_t kKept = 1024;
    if (all_.size() < 2 * std::max(tidied_, kKept)) return;
    forget_taken();
    std::erase_if(all_, [&](const T& one) { return !useful(one); });
    tidied_ = all_.size();
  }
  std::size_t memory_bytes() const noexcept { return bytes_of(all_); }

 private:
  void forget_taken() noexcept {
    all_.erase(all_.begin(), all_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
  }

  std::vector<T> all_;
  std::size_t first_ = 0, tidied_ = 0;
};

// What a budget has left over, by importance class, each in the order in which it came: so every body and every pair
// gets its turn, however little is done at a step.
class Backlog {
 public:
  struct Rank {
    WorkQueue<BodyIndex> updates;  // bodies that wait for a window update, and some that do not any more
    std::size_t bodies = 0;        // that do
    WorkQueue<PairEvent> found;    // near pairs that these updates found: tested before the next update
    WorkQueue<PairEvent> due;      // pairs whose test is due, and what other classes' updates found
    std::int64_t lead = 0;         // units of work that updates are ahead of tests

    bool updating() const noexcept { return bodies > 0 || !found.empty(); }
  };

  Rank& rank(unsigned importance);
  void wait(BodyIndex body, std::uint8_t importance);  // at the end, unless it waits already
  void leave(BodyIndex body) noexcept;                 // nothing if it does not wait
  bool waits(BodyIndex body) const noexcept { return body < waits_in_.size() && waits_in_[body] != kNoWhere; }
  // The first bodies of the class leave; returns how many.
  std::size_t take(unsigned importance, std::span<BodyIndex> bodies) noexcept;
  // Everything leaves, the more important classes first.
  void take_all(std::vector<BodyIndex>& bodies, std::vector<PairEvent>& pairs);
  void append_bodies(std::vector<BodyIndex>& bodies) const;  // those that wait
  bool empty() const noexcept { return size() == 0; }
  bool no_body_waits() const noexcept;
  std::size_t size() const noexcept;  // bodies and pairs
  std::size_t memory_bytes() const noexcept;

 private:
  static constexpr std::uint16_t kNoWhere = 0xffff;

  std::deque<Rank> ranks_;               // stay where they are when others come
  std::vector<std::uint16_t> waits_in_;  // by body: the class, or kNoWhere; empty until a body waits
};

}  // namespace orchard::runtime::detail
