#pragma once
#include <array>

#include "collision/kernels/placement.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime::detail {

using SegmentGaps = std::array<float, kBlockWidth>;

// Computes lower bounds on the distances of eight triangles from the segment from p to q, in the tree's frame. For
// triangles that are apart from the segment, a bound is hardly more than twice the placement's margin too low. Unused
// lanes repeat the first one. Only the unit and the margin of the placement are used. The margin has to be 128 u times
// the size of all coordinates, with u = 2^-24, plus the error of the ends.
void segment_gaps(const std::array<float, 3>& p, const std::array<float, 3>& q, const TriangleBlock& block,
                  const Placement& placement, SegmentGaps& lower) noexcept;

}  // namespace orchard::runtime::detail
