#pragma once
#include <deque>

#include "broad_phase/timing_wheel.h"

namespace orchard::runtime::detail {

// Pairs in the order in which they came.
class PairQueue {
 public:
  bool empty() const noexcept { return first_ == pairs_.size(); }
  std::size_t size() const noexcept { return pairs_.size() - first_; }
  void push(const PairEvent& event) { pairs_.push_back(event); }
  const PairEvent& front() const noexcept { return pairs_[first_]; }
  PairEvent pop() noexcept;
  void move_to(std::vector<PairEvent>& pairs);  // the ends of them
  // Drops what is of no use any more, once the queue has doubled: little work per pair, and no endless growth.
  template <typename Useful>
  void tidy(const Useful& useful) {
    constexpr std::size_t kKept = 1024;
    if (pairs_.size() < 2 * std::max(tidied_, kKept)) return;
    pairs_.erase(pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
    std::erase_if(pairs_, [&](const PairEvent& event) { return !useful(event); });
    tidied_ = pairs_.size();
  }
  std::size_t memory_bytes() const noexcept { return bytes_of(pairs_); }

 private:
  std::vector<PairEvent> pairs_;
  std::size_t first_ = 0, tidied_ = 0;
};

// What a budget has left over, by importance class, each in the order in which it came: so every body and every pair
// gets its turn, however little is done at a step.
class Backlog {
 public:
  struct Rank {
    BodyIndex first = kNoIndex, last = kNoIndex;  // the bodies that wait for a window update: a list
    PairQueue found;                              // near pairs that these updates found: tested before the next update
    PairQueue due;                                // pairs whose test is due, and what other classes' updates found
    std::int64_t lead = 0;                        // units of work that updates are ahead of tests
    std::size_t bodies = 0;

    bool updating() const noexcept { return bodies > 0 || !found.empty(); }
  };

  Rank& rank(unsigned importance);
  void wait(BodyIndex body, std::uint8_t importance);  // at the end, unless it waits already
  void leave(BodyIndex body) noexcept;                 // nothing if it does not wait
  bool waits(BodyIndex body) const noexcept { return body < links_.size() && links_[body].waits; }
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
  struct Link {
    BodyIndex next = kNoIndex, before = kNoIndex;
    std::uint8_t importance = 0;
    bool waits = false;
  };

  std::deque<Rank> ranks_;   // stay where they are when others come
  std::vector<Link> links_;  // by body; empty until a body waits
};

}  // namespace orchard::runtime::detail
