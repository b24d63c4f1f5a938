#pragma once
#include <array>

#include "collision/kernels/placement.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime::detail {

using SegmentGaps = std::array<float, kBlockWidth>;

// Lower bounds on the distances of eight triangles from the segment from p to q, in the tree's frame, hardly more than
// twice the placement's margin below them where they are apart; unused lanes repeat the first one. Of the placement its
// unit counts and its margin: 128 u of the size of all coordinates, u = 2^-24, and what the ends may be off by.
void segment_gaps(const std::array<float, 3>& p, const std::array<float, 3>& q, const TriangleBlock& block,
                  const Placement& placement, SegmentGaps& lower) noexcept;

}  // namespace orchard::runtime::detail
