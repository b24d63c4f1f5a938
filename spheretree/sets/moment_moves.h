#pragma once
#include <vector>

#include "packing.h"

namespace orchard::detail {

// How far the moments of equal balls are from those wanted, as a multiple of what is allowed: the larger one.
double moment_excess(const std::vector<Point>& centers, double radius, const PackingMoments& moments);

// Moves single balls of one radius to places where they have room, each time the move that brings the moments nearest
// to those wanted, until they are within `enough` times the errors or no move helps. `contact`: the least distance of
// two centres, in radii. O(n k) for k places, and at most as many moves as there are balls. Returns moment_excess().
double move_to_moments(const std::vector<Sphere>& places, double contact, double radius, double enough,
                       const PackingMoments& moments, std::vector<Point>& centers);

}  // namespace orchard::detail
