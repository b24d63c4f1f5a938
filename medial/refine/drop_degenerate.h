#pragma once
#include "../balls/ball_complex.h"

namespace orchard::detail {

// Merges vertices that an edge joins and that are within `apart` (mesh units) of each other. Removes flat triangles:
// the longest edge of one is divided at its third corner, in all triangles at the edge. Where that would change the
// topology, such cells stay. Returns the number of merged vertices and removed triangles. O(n log n).
Index drop_degenerate(BallComplex& complex, double apart);

}  // namespace orchard::detail
