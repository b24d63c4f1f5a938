#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>

#include "orchard/runtime/packed_tree.h"
#include "simd/vector_support.h"

namespace orchard::runtime::detail {

// Sorts the children of a pair for a stack: the one with the least key comes last, so that it is popped first; of
// children with equal keys, it is the later one. The place of each child comes from comparing it with all others,
// because a sorting algorithm has branches that no processor predicts.
struct FarthestFirst {
  std::uint32_t place[kBlockWidth], count = 0;
  float keys[kBlockWidth];

  ORCHARD_INLINE void add(float key) noexcept {
    std::uint32_t before = count;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t less = keys[i] < key;
      place[i] += less;
      before -= less;
    }
    place[count] = before, keys[count++] = key;
  }
};

// Pushes an entry for each lane of a bit mask on a stack, the one with the least key last. entry_of(lane) makes an
// entry, and key_of(entry, lane) returns its key. `size` is the size of the stack before; the new size is returned.
template <typename Entry, typename EntryOf, typename KeyOf>
ORCHARD_INLINE std::size_t push_farthest_first(Entry* stack, std::size_t size, std::uint32_t lanes, EntryOf&& entry_of,
                                               KeyOf&& key_of) noexcept {
  Entry entries[kBlockWidth];
  FarthestFirst order;
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    Entry& entry = entries[order.count];
    entry = entry_of(lane);
    order.add(key_of(entry, lane));
  }
  for (std::uint32_t i = 0; i < order.count; ++i) stack[size + order.place[i]] = entries[i];
  return size + order.count;
}

}  // namespace orchard::runtime::detail
