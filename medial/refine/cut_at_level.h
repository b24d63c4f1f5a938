#pragma once
#include <vector>

#include "../balls/ball_complex.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Shortens sheets to the places where a border would lose `level` (mesh units). Triangles are cut along the line on
// which the loss has this value, at exact balls. The cells with a smaller loss are removed from their free ends on,
// which does not change the topology. `merging` (mesh units) is that of BallSolver. Returns the number of edges that
// were cut. The result is deterministic; the work is parallel. Takes O(n log n), and some nearest-point queries for
// each cut edge.
Index cut_at_level(const Surface& surface, BallComplex& complex, double level, double merging);

// Does the same for a measure whose value at each vertex, beside the level, is `over_level`: cuts where it passes 1,
// interpolated along the edges.
Index cut_where_below(const Surface& surface, BallComplex& complex, const std::vector<double>& over_level,
                      double merging);

}  // namespace orchard::detail
