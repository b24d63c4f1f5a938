#pragma once
#include "ball_complex.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Moves vertices of triangles that are flat, as the topology needs some to be, off the line of the other two: along
// their sheet, by hardly more than makes a triangle one with a plane of its own, to another exact ball. Flat triangles
// make programs that project onto planes go wrong. `merging` as BallSolver has it. Returns how many vertices were
// moved.
Index spread_flat(const Surface& surface, BallComplex& complex, double merging);

}  // namespace orchard::detail
