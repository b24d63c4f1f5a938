#pragma once
#include "boundary_reach.h"

namespace orchard::detail {

// Does the same as max_dent(), by cubes around the solid. They are divided until no cube can hold a dent that exceeds
// the found maximum by more than the larger of `accuracy` (mesh units) and 2 %, or until `max_cubes` have been looked
// at: then `upper` bounds what is left open. Takes about one query of each kind for each cube, and about (D / known)^2
// cubes, where D is the diagonal, so it is meant for deep dents. Works for any solid, even if its surface cuts itself.
// Parallel; the result does not depend on the number of threads.
SearchedMax max_deep_dent(const Surface& surface, const Reconstruction& reconstruction, double known, double accuracy,
                          Index max_cubes);

}  // namespace orchard::detail
