#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Returns, for each point, whether it is kept. Gap repair gives every point of a thin part a point on the opposite
// sheet, which doubles the points, although half as many pairs would suffice. So pairs are removed, the most crowded
// ones first. A pair consists of two points of opposite sheets each of which is the nearest one across for the other,
// at a distance of at most `spacing`. It is removed if each of its points has another kept point on its own sheet
// within kCrowded spacings. O(n log n).
std::vector<std::uint8_t> without_crowded_pairs(const Surface& surface, const SurfaceSampling& sampling,
                                                double spacing);

// Returns the points that are kept, in their order.
SurfaceSampling points_that_stay(const SurfaceSampling& sampling, const std::vector<std::uint8_t>& stay);

}  // namespace orchard::detail
