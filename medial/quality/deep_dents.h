#pragma once
#include "boundary_reach.h"

namespace orchard::detail {

// max_dent() by cubes around the solid, which are divided until none can have more than the larger of `accuracy` (mesh
// units) and 2 % above what was found, or until `max_cubes` were: `upper` says then how much is left open. About one
// query of each kind for each cube, and some (D / known)^2 cubes, D being the diagonal: for what lies deep. Any solid,
// one whose surface cuts itself, too. Parallel, and the same for any number of threads.
SearchedMax max_deep_dent(const Surface& surface, const Reconstruction& reconstruction, double known, double accuracy,
                          Index max_cubes);

}  // namespace orchard::detail
