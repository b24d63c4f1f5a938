#pragma once
#include "ball_complex.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Solves the balls inside sheets anew that stand out: those that are not exact, and those with less than half the
// radius of every neighbour, as at one place of a thin wall where both contacts came to lie on one side. It starts from
// the middle of the exact neighbours, with their contacts, and is taken if it stays between them. Returns how many
// balls were. `merging` (mesh units) is that of BallSolver. Deterministic; parallel. O(n).
Index solve_outliers_again(const Surface& surface, BallComplex& complex, double merging);

}  // namespace orchard::detail
