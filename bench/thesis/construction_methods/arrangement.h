#pragma once
#include <vector>

#include "orchard/covering/planar_cover.h"

namespace orchard::construction_methods {

// 3 to 28 disks, rectangles and convex polygons at random over the unit square, of which about a third covers it.
std::vector<PlanarShape> random_arrangement(std::uint64_t seed);

// `count` disks at random over the unit square, just so large that they cover it with a probability of about one half.
std::vector<PlanarShape> many_disks(std::size_t count, std::uint64_t seed);

}  // namespace orchard::construction_methods
