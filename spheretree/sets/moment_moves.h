#pragma once
#include <vector>

#include "packing.h"

namespace orchard::detail {

// How far the moments of equal balls are from the wanted ones, as a multiple of the allowed error: the largest of these
// multiples.
double moment_excess(const std::vector<Point>& centers, double radius, const PackingMoments& moments);

// Moves balls of one radius, one at a time, to free places where they have room: always the move that brings the
// moments nearest to the wanted ones, until moment_excess() is at most `enough`, no move helps, or there have been as
// many moves as there are balls. `contact`: the least distance of two centres, in radii. O(n k) for k places. Returns
// moment_excess().
double move_to_moments(const std::vector<Sphere>& places, double contact, double radius, double enough,
                       const PackingMoments& moments, std::vector<Point>& centers);

}  // namespace orchard::detail
