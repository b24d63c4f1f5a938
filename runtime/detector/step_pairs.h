#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "broad_phase/body_pool.h"

namespace orchard::runtime::detail {

// The pairs of bodies that a step asks about, from where they are found, in ascending order. Keeps its memory.
class StepPairs {
 public:
  // Filled by the step before merge(): with half-spaces; those that an interrupted broad phase did not get to; those
  // that are found by their parts.
  std::vector<BodyPair> with_planes, kept, by_parts;

  void clear() noexcept { with_planes.clear(), kept.clear(), by_parts.clear(); }
  // The broad phase's own list is used as it is, and has to stay, where there are no others.
  void merge(std::span<const BodyPair> of_broad_phase) {
    all_ = merged(of_broad_phase, kept, with_kept_);
    all_ = merged(all_, by_parts, with_parts_);
    all_ = merged(all_, with_planes, with_all_);
  }
  std::span<const BodyPair> all() const noexcept { return all_; }
  std::size_t memory_bytes() const noexcept {
    return bytes_of(with_planes, kept, by_parts, with_kept_, with_parts_, with_all_);
  }

 private:
  // `more` mostly is none or few. In `both`, if there are any.
  static std::span<const BodyPair> merged(std::span<const BodyPair> some, std::span<const BodyPair> more,
                                          std::vector<BodyPair>& both) {
    if (more.empty()) return some;
    if (some.empty()) return more;
    both.resize(some.size() + more.size());
    std::merge(some.begin(), some.end(), more.begin(), more.end(), both.begin());
    return both;
  }

  std::vector<BodyPair> with_kept_, with_parts_, with_all_;
  std::span<const BodyPair> all_;
};

}  // namespace orchard::runtime::detail
