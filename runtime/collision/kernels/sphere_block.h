#pragma once
#include <array>
#include <cstdint>

#include "collision/kernels/placement.h"
#include "orchard/runtime/packed_tree.h"

// The inner loop of the narrow phase: up to eight siblings of one tree against up to eight of the other.
namespace orchard::runtime::detail {

// The input of test_block().
struct BlockPair {
  const SiblingBlock *rows, *lanes;
  std::uint32_t row_begin, row_end;  // the rows to test
  std::uint32_t lane_count;          // the number of lanes in use
  bool lanes_are_second;  // the lanes belong to the second tree, the rows to the first; or the other way round
};

// The result of test_block(). Bit 8 * row + lane of a mask stands for a pair.
struct BlockHits {
  std::uint64_t meeting;    // pairs with square <= reach^2
  std::uint64_t leaves;     // of these, the pairs of two leaves
  std::uint64_t improving;  // of these, the pairs whose separation bound may be below the best one
  // The squares of the distances of the centres, for the rows that were tested.
  alignas(32) std::array<std::array<float, kBlockWidth>, kBlockWidth> square;
};

// Tests the rows of a pair of blocks against the lanes, and updates `level`.
void test_block(const BlockPair& pair, const Placement& placement, LevelState& level, BlockHits& hits) noexcept;

}  // namespace orchard::runtime::detail
