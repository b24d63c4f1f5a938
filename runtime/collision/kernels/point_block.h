#pragma once
#include <array>

#include "collision/kernels/placement.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime::detail {

using PointGaps = std::array<float, kBlockWidth>;

// Lower bounds on the distances of eight triangles from a point, in the tree's frame, hardly more than the placement's
// margin below them unless a triangle is a needle; unused lanes repeat the first one. Of the placement its unit counts
// and its margin: 128 u of the size of all coordinates, u = 2^-24, and what the point may be off by.
void point_gaps(const std::array<float, 3>& point, const TriangleBlock& block, const Placement& placement,
                PointGaps& lower) noexcept;

}  // namespace orchard::runtime::detail
