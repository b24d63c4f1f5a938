#pragma once
#include "ball_complex.h"

namespace orchard::detail {

// Takes sheets away that double others, as the diagram has them in parts of the solid that are thinner than the points'
// spacing, and spikes beside others: from their borders on those triangles whose balls, at thirds of their sides and
// their middles, lie within `apart` (mesh units) in balls of triangles that stay, as long as the borders become shorter
// by `gain` (mesh units) or more each time. It is free: it changes no topology. Returns how many triangles went. O(n
// log n).
Index drop_doubled(BallComplex& complex, double apart, double gain);

}  // namespace orchard::detail
