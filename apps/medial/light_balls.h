#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::apps {

// At most `most` balls that stand for all of them: the largest ball of each cell of a grid of cubes, which is as fine
// as the number allows. Returns their numbers, ascending; all of them if there are no more. Ties go to the lower
// number. Precondition: most > 0. Time: O(n log n), some 40 times.
std::vector<Index> light_balls(std::span<const Sphere> balls, Index most);

}  // namespace orchard::apps
