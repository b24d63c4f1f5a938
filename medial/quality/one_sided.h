#pragma once
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Whether the solid is nowhere on the outer side of its surface. That is so if only adjacent triangles meet, and no
// part of the surface lies inside another one that winds in the same direction. O(n) after the self-intersections have
// been found once.
bool one_sided(const Surface& surface);

}  // namespace orchard::detail
