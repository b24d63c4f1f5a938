#pragma once
#include <span>

#include "fit.h"

namespace orchard::detail {

// Puts up to `count` new vertices where the distances of the samples, or what protrudes, are largest: in the middle of
// the longest edge of the cell that is to blame, or, where a sample lies beyond a border, at the sample itself. Keeps
// the homotopy type. The feet are cells of the mesh again, but not the nearest. Returns how many.
Index insert_at_worst(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples,
                      Assignment& feet, Index count);

}  // namespace orchard::detail
