#pragma once
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Whether the solid is nowhere on the outer side of its surface: no triangles meet but neighbours, and no part of the
// surface lies inside another that winds the same way. O(n), after the self-intersections have been found once.
bool one_sided(const Surface& surface);

}  // namespace orchard::detail
