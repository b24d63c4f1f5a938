#pragma once
#include <deque>

#include "broad_phase/timing_wheel.h"

namespace orchard::runtime::detail {

// A queue of bodies or pairs.
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
  void move_to(std::vector<T>& to) {  // appends everything to `to` and empties the queue
    to.insert(to.end(), all_.begin() + static_cast<std::ptrdiff_t>(first_), all_.end());
    all_.clear();
    first_ = tidied_ = 0;
  }
  // Drops the elements for which useful() is false, but only if the queue has doubled since the last time. So it costs
  // little per element, and the queue does not grow endlessly.
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

// The work that a budget has left over, by class of importance. In a class, bodies and pairs are served in the order in
// which they came, so each of them gets its turn, however little is done at a step.
class Backlog {
 public:
  struct Rank {
    WorkQueue<BodyIndex> updates;  // bodies that wait for a window update, and some that do not any more
    std::size_t bodies = 0;        // the number of those that wait
    WorkQueue<PairEvent> found;    // near pairs that these updates found; they are tested before the next update
    WorkQueue<PairEvent> due;      // pairs whose test is due, and near pairs that updates of other classes found
    std::int64_t lead = 0;         // the work done for updates less that done for tests, in units of the budget

    bool updating() const noexcept { return bodies > 0 || !found.empty(); }
  };

  Rank& rank(unsigned importance);
  void wait(BodyIndex body, std::uint8_t importance);  // puts it at the end of the class, unless it waits already
  void leave(BodyIndex body) noexcept;                 // does nothing if it does not wait
  bool waits(BodyIndex body) const noexcept { return body < waits_in_.size() && waits_in_[body] != kNoWhere; }
  // Moves the first bodies of the class to `bodies`, until that is full or none is left. Returns how many it has moved.
  std::size_t take(unsigned importance, std::span<BodyIndex> bodies) noexcept;
  // Moves everything to the ends of the vectors, the more important classes first.
  void take_all(std::vector<BodyIndex>& bodies, std::vector<PairEvent>& pairs);
  void append_bodies(std::vector<BodyIndex>& bodies) const;  // appends those that wait
  bool empty() const noexcept { return size() == 0; }
  bool no_body_waits() const noexcept;
  std::size_t size() const noexcept;  // the number of bodies and pairs that wait
  std::size_t memory_bytes() const noexcept;

 private:
  static constexpr std::uint16_t kNoWhere = 0xffff;

  std::deque<Rank> ranks_;               // by class; references to them stay valid when others are added
  std::vector<std::uint16_t> waits_in_;  // by body: the class, or kNoWhere; empty until a body waits
};

}  // namespace orchard::runtime::detail
