#pragma once
#include <chrono>
#include <cstdint>
#include <limits>

namespace orchard::runtime {

// Limits of one call. The call stops at the first limit that it reaches. What a unit of work is, and by how much a call
// may exceed its budget, depends on what is asked: NarrowPhase counts tests of nodes and triangles, BroadPhase counts
// motions that it asks for, and Detector counts both.
struct Budget {
  std::uint64_t work = std::numeric_limits<std::uint64_t>::max();
  std::chrono::nanoseconds time = std::chrono::nanoseconds::max();  // by the steady clock

  bool limited() const noexcept { return work != Budget{}.work || time != Budget{}.time; }
  friend bool operator==(const Budget&, const Budget&) = default;
};

}  // namespace orchard::runtime
