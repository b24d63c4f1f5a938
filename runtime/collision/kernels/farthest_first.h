#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>

#include "orchard/runtime/packed_tree.h"
#include "simd/vector_support.h"

namespace orchard::runtime::detail {

// The order of the children of a pair, the least last, where a stack is opened first; of equal ones the later one.
// Each one's place comes from comparing all: sorting them takes branches that nothing foresees.
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

// Puts an entry on a stack for each of these lanes, the one of the least key last. `entry_of(lane)` makes an entry,
// `key_of(entry, lane)` its key. Returns the size of the stack, which was `size`.
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
