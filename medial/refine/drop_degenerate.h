#pragma once
#include "../balls/ball_complex.h"

namespace orchard::detail {

// Merges vertices that one edge joins and that are within `apart` (mesh units) of each other, and takes triangles away
// that are flat, by dividing their longest edge, in all triangles at it, at the third corner. Neither changes the
// topology; where it would, such cells stay. Returns how many vertices were merged and flat triangles taken away. O(n
// log n).
Index drop_degenerate(BallComplex& complex, double apart);

}  // namespace orchard::detail
