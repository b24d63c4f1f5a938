#pragma once
#include "ball_complex.h"
#include "orchard/medial/axis.h"

namespace orchard::detail {

// Converts a complex of balls to a medial axis. Its vertices keep their order, its faces are the triangles, it has no
// topology faces, and its points are the contacts, vertex by vertex. O(n log n).
MedialAxis axis_of_balls(const Surface& surface, const BallComplex& complex);

}  // namespace orchard::detail
