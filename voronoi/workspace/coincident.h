#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Pairs (point left out, point it coincides with): a point is left out if an earlier point that stays lies within the
// distance. Ascending by the first. Expected O(n) by a hash grid.
std::vector<std::array<Index, 2>> coincident_points(std::span<const Point> points, double distance);

// The same for the points from `first_new` on; of those before, the ones that `present` names stay without question.
std::vector<std::array<Index, 2>> coincident_points(std::span<const Point> points, double distance, Index first_new,
                                                    const std::vector<bool>& present);

}  // namespace orchard::detail
