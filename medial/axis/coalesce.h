#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Returns for each point the lowest index among the points that a chain of steps no longer than `distance` connects it
// to; that is its own index if there is no other. A spatial hash finds coincident Voronoi vertices in this way whether
// or not an edge joins them (dissertation 6.2.1, after Turk 1990). O(n) for points that are mostly farther apart.
// Precondition: distance > 0, finite points.
std::vector<Index> representatives_of_coincident(std::span<const Point> points, double distance);

}  // namespace orchard::detail
