#pragma once
#include <span>

#include "fit_samples.h"
#include "foot.h"
#include "orchard/medial/simplify.h"

namespace orchard::detail {

// The largest distance from a point of the surface to the envelope: an upper bound, at most `slack` above what some
// point has, and at least `known`. By branch and bound: on a piece of a triangle the distance to one cell is convex, so
// no more than at the corners. Deterministic.
double max_gap(const Surface& surface, const ContractibleMesh& mesh, const FootFinder& finder, double known,
               double slack);

// Fills in the distances of a report.
void measure_two_sided(const Surface& surface, const ContractibleMesh& mesh, const SimplifyOptions& options,
                       SimplifyReport& report);

}  // namespace orchard::detail
