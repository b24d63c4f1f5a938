#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Sorts numbers. If all are below 2^22 and two passes of a radix sort with 11 bits each are faster than comparisons, it
// uses these passes.
inline void sort_indices(std::vector<Index>& numbers) {
  constexpr std::size_t kMany = 1024;
  constexpr unsigned kBits = 11;
  constexpr Index kMask = (Index{1} << kBits) - 1;
  if (numbers.size() < kMany || *std::max_element(numbers.begin(), numbers.end()) >> (2 * kBits) != 0) {
    std::sort(numbers.begin(), numbers.end());
    return;
  }
  thread_local std::vector<Index> other;
  other.resize(numbers.size());
  for (const unsigned shift : {0u, kBits}) {
    std::array<Index, kMask + 1> place{};
    for (const Index number : numbers) ++place[(number >> shift) & kMask];
    Index before = 0;
    for (Index& at : place) {
      const Index count = at;
      at = before;
      before += count;
    }
    for (const Index number : numbers) other[place[(number >> shift) & kMask]++] = number;
    numbers.swap(other);
  }
}

}  // namespace orchard::detail
