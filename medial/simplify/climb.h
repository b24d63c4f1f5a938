#pragma once
#include <vector>

#include "fit_samples.h"
#include "foot.h"

namespace orchard::detail {

// Moves samples of the surface uphill to nearby places where the envelope of the mesh is farthest off. The first steps
// have length `reach` (mesh units), and later ones are ever smaller. Samples that arrive at the same place are merged.
// Parallel, deterministic.
void climb(const Surface& surface, const ContractibleMesh& mesh, double reach, std::vector<FitSample>& samples);

}  // namespace orchard::detail
