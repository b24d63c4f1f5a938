#pragma once
#include <span>

#include "fit.h"

namespace orchard::detail {

// Adds up to `count` vertices where the distances of samples or the protrusions are largest. A new vertex is in the
// middle of the longest edge of the cell concerned, or, if a sample lies beyond a border, at the sample itself. The
// homotopy type stays. Afterwards the feet are on cells of the mesh, but not the nearest ones. Returns the number of
// vertices added.
Index insert_at_worst(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples,
                      Assignment& feet, Index count);

}  // namespace orchard::detail
