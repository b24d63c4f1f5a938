#pragma once
#include <span>

#include "../balls/split.h"
#include "../extend/borders.h"
#include "uncovered.h"

namespace orchard::detail {

// Reaches for places that the balls leave open, by adding a triangle for each place. Its first two corners are an edge
// of a border near the place: of the edges from which the triangle can be divided (SplitOptions) until it is right, the
// one by which the borders become longer by the least, so that places along a ridge get one sheet. If there is none,
// the edges nearest to the place's nearest ball are tried, borders first. The third corner is a ball that leaves the
// place open by `left` (mesh units), or covers it if it is on a sharp edge. If such a ball cannot be reached, it is one
// that leaves half of the present distance open, or the triangle starts farther back, or the ball lies beside the axis
// and is inexact. `reconstruction` is that of the complex as it is given. Returns the number of places reached.
Index reach_open_places(const Surface& surface, BallComplex& complex, BallSolver& solver,
                        const Reconstruction& reconstruction, std::span<const UncoveredPlace> places, double left,
                        const BorderOptions& options, const SplitOptions& dividing);

}  // namespace orchard::detail
