#pragma once
#include <span>

#include "orchard/medial/simplify.h"

namespace orchard::detail {

// Fills in the distances of a report as medial_quality() measures them, from options.check places of the surface and
// from the centres of the given balls, which have to be in the solid.
void measure_two_sided(const Surface& surface, const MedialMesh& mesh, std::span<const Sphere> inscribed,
                       const SimplifyOptions& options, SimplifyReport& report);

}  // namespace orchard::detail
