#pragma once
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"

namespace orchard::detail {

// Fills the axis's points, origins, normals and turns from a sampling.
void add_points(const Surface& surface, const SurfaceSampling& sampling, MedialAxis& axis);

}  // namespace orchard::detail
