#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "collision/kernels/node_box.h"
#include "collision/kernels/placement.h"
#include "math/triangle_pair.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

// The inner loops over triangles of the exact level and of distance queries: eight against eight.
namespace orchard::runtime::detail {

// The triangles of two leaves.
struct LeafPair {
  const TriangleBlock &lanes, &rows;  // of the first tree, and of the second one, in its own frame
  const NodeBox &lane_box, &row_box;  // the boxes of the leaves, both in the first tree's frame
};

// Finds the pairs that may share a point, and never leaves out one that does. Calls visit(context, row, bits of lanes)
// for each row that has such a pair, in order, until it returns true. Returns whether it did.
using CandidateVisit = bool (*)(const void* context, std::uint32_t row, std::uint32_t lanes);
bool visit_candidates(const LeafPair& pair, const Placement& placement, CandidateVisit visit,
                      const void* context) noexcept;

// Does the same pair by pair: calls take(lane, row) until it returns true.
template <typename Take>
bool each_candidate(const LeafPair& pair, const Placement& placement, const Take& take) noexcept {
  const auto visit = [](const void* context, std::uint32_t row, std::uint32_t lanes) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      if ((*static_cast<const Take*>(context))(lane, row)) return true;
    }
    return false;
  };
  return visit_candidates(pair, placement, visit, &take);
}

// Certified lower bounds on the distances of triangles. They are negative if nothing is known. Unused rows and lanes
// have arbitrary values.
struct TriangleGaps {
  alignas(32) std::array<std::array<float, kBlockWidth>, kBlockWidth> lower;  // [row][lane]
  std::array<std::uint32_t, kBlockWidth> near;  // [row], bits: lanes that are no farther than `reach`
  float beyond;                                 // the least bound of all others, or infinity
};
// Computes these bounds. `direction` is another axis to try, of length at most 1. A row of which all triangles are
// farther than `reach` gets bounds that are just sharp enough to show this.
void triangle_gaps(const TriangleBlock& lanes, const TriangleBlock& rows, const Placement& placement,
                   const std::array<float, 3>& direction, float reach, TriangleGaps& result) noexcept;
// Calls take(lane, row, lower bound) for the triangles within reach, the nearest first, until it returns false. Returns
// a lower bound on the distance of all other pairs. It does not sort them, because few are taken.
template <typename Take>
float each_nearest_first(const TriangleGaps& gaps, const Take& take) noexcept {
  const auto ordered = [](float value) -> std::uint64_t {  // compares as the float does; of 32 bits
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return bits ^ ((bits >> 31) != 0 ? 0xffffffffu : 0x80000000u);
  };
  std::array<std::uint64_t, std::size_t{kBlockWidth} * kBlockWidth> left;
  std::size_t count = 0;
  for (std::uint32_t row = 0; row < kBlockWidth; ++row) {
    for (std::uint32_t near = gaps.near[row]; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
      left[count++] = ordered(gaps.lower[row][lane]) << 32 | (kBlockWidth * row + lane);
    }
  }
  for (; count > 0; --count) {
    auto nearest = std::min_element(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(count));
    const auto row = static_cast<std::uint32_t>(*nearest) / kBlockWidth,
               lane = static_cast<std::uint32_t>(*nearest) % kBlockWidth;
    *nearest = left[count - 1];
    if (!take(lane, row, gaps.lower[row][lane])) return std::min(gaps.beyond, gaps.lower[row][lane]);
  }
  return gaps.beyond;
}

// Return the corners of a triangle, and the corners after they are moved by a pose.
TrianglePoints points_of(const TriangleBlock& block, std::uint32_t lane) noexcept;
TrianglePoints moved_points_of(const TriangleBlock& block, std::uint32_t lane, const Pose& pose) noexcept;

}  // namespace orchard::runtime::detail
