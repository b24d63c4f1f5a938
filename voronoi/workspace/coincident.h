#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Finds coincident points. Returns pairs (point to leave out, point that it coincides with), ascending by the first. A
// point is left out if an earlier point that is not left out lies within the distance. Expected time O(n), by a hash
// grid.
std::vector<std::array<Index, 2>> coincident_points(std::span<const Point> points, double distance);

// The same for the points from `first_new` on. Of the points before, those that `present` names are never left out.
std::vector<std::array<Index, 2>> coincident_points(std::span<const Point> points, double distance, Index first_new,
                                                    const std::vector<bool>& present);

}  // namespace orchard::detail
