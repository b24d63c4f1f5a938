#pragma once
#include "orchard/medial/simplify.h"

namespace orchard::detail {

// Fills in the distances of a report, as medial_quality() measures them, from options.check places of the surface.
void measure_two_sided(const Surface& surface, const MedialMesh& mesh, const SimplifyOptions& options,
                       SimplifyReport& report);

}  // namespace orchard::detail
