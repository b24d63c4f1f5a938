#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Of each point whether it stays. Two points of opposite sheets, each the other's nearest one across and no farther
// than `spacing`, go together if both have another point that stays on their own sheet within kCrowded spacings: gap
// repair gives every point of a thin part one across, which doubles them, while half as many pairs would do. The most
// crowded pairs first. O(n log n).
std::vector<std::uint8_t> without_crowded_pairs(const Surface& surface, const SurfaceSampling& sampling,
                                                double spacing);

// The points that stay, in their order.
SurfaceSampling points_that_stay(const SurfaceSampling& sampling, const std::vector<std::uint8_t>& stay);

}  // namespace orchard::detail
