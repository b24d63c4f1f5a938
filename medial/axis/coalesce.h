#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// For each point the lowest index among the points that a chain of steps no longer than `distance` joins it to (its own
// if none): coincident Voronoi vertices are found by a spatial hash whether or not an edge joins them (dissertation
// 6.2.1, after Turk 1990). O(n) for points that are mostly farther apart. Precondition: distance > 0, finite points.
std::vector<Index> representatives_of_coincident(std::span<const Point> points, double distance);

}  // namespace orchard::detail
