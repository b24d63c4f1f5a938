#pragma once
#include <array>
#include <cstdint>

#include "collision/kernels/placement.h"
#include "orchard/runtime/packed_tree.h"

// The inner loop of the narrow phase: up to eight siblings of one tree against up to eight of the other.
namespace orchard::runtime::detail {

struct BlockPair {
  const SiblingBlock *rows, *lanes;
  std::uint32_t row_begin, row_end;  // the rows to test
  std::uint32_t lane_count;          // lanes in use
  bool lanes_are_second;  // the lanes belong to the second tree, the rows to the first; or the other way round
};

// Bit 8 * row + lane of a mask stands for a pair.
struct BlockHits {
  std::uint64_t meeting;    // square <= reach^2
  std::uint64_t leaves;     // those of them that are two leaves
  std::uint64_t improving;  // those of them whose separation bound may lie below the best one
  alignas(32) std::array<std::array<float, kBlockWidth>, kBlockWidth> square;  // of the centres' distance, rows tested
};

void test_block(const BlockPair& pair, const Placement& placement, LevelState& level, BlockHits& hits) noexcept;

}  // namespace orchard::runtime::detail
