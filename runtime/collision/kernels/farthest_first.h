#pragma once
#include <cstdint>

#include "collision/kernels/obb_node_block.h"
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

}  // namespace orchard::runtime::detail
