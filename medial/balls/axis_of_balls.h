#pragma once
#include "ball_complex.h"
#include "orchard/medial/axis.h"

namespace orchard::detail {

// A complex of balls as a medial axis: vertices in their order, triangles for faces, no walls; its points are the
// contacts, vertex by vertex. O(n log n).
MedialAxis axis_of_balls(const Surface& surface, const BallComplex& complex);

}  // namespace orchard::detail
