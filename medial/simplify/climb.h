#pragma once
#include <vector>

#include "fit_samples.h"
#include "foot.h"

namespace orchard::detail {

// Moves samples of the surface to where nearby the envelope of the mesh is off the most: `reach` (mesh units) away at
// first, in ever smaller steps. Those that come to the same place become one. Parallel, deterministic.
void climb(const Surface& surface, const ContractibleMesh& mesh, double reach, std::vector<FitSample>& samples);

}  // namespace orchard::detail
