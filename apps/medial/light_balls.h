#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::apps {

// Returns at most `most` balls that represent all of them: the largest ball of each cell of a grid of cubes, which is
// as fine as the number allows. The result is ascending numbers, and all of them if there are no more than `most`. Of
// equal balls, the one with the lower number is taken. Precondition: most > 0. Time: O(n log n), repeated some 40
// times.
std::vector<Index> light_balls(std::span<const Sphere> balls, Index most);

}  // namespace orchard::apps
