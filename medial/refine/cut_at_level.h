#pragma once
#include "../balls/ball_complex.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Cuts sheets along the line inside their triangles where what a border loses is `level` (mesh units), by exact balls,
// and takes away what loses less from the free ends on, so that the topology stays. `merging` (mesh units) is that of
// BallSolver. Returns how many edges were cut. Deterministic; parallel. O(n log n), and some nearest-point queries for
// each edge that is cut.
Index cut_at_level(const Surface& surface, BallComplex& complex, double level, double merging);

}  // namespace orchard::detail
