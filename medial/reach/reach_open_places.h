#pragma once
#include <span>

#include "../balls/split.h"
#include "../extend/borders.h"
#include "uncovered.h"

namespace orchard::detail {

// Reaches for places that the balls leave open: by a triangle beside the borders near them, from the edge from where
// they become longer by the least and the triangle can be divided (SplitOptions) until it is right, so that places
// along a ridge get one sheet; where there is none, from the edges nearest to the place's nearest ball, borders before
// others. The third ball leaves `left` (mesh units) open there, and where a place is on a sharp edge nothing; where
// none may be, it leaves half of it open, or comes from farther back, or is beside the axis and inexact.
// `reconstruction` is that of the complex as it is. Returns the number of places reached.
Index reach_open_places(const Surface& surface, BallComplex& complex, BallSolver& solver,
                        const Reconstruction& reconstruction, std::span<const UncoveredPlace> places, double left,
                        const BorderOptions& options, const SplitOptions& dividing);

}  // namespace orchard::detail
