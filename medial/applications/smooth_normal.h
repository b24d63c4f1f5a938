#pragma once
#include "orchard/medial/thickness.h"

namespace orchard::detail {

// The outward unit normal, at a place of a mesh, of the smooth surface that the mesh approximates. Two facets belong to
// the same smooth surface if the angle between their normals is less than that of the given cosine. On a face the
// normal is interpolated between the normals at its corners (Phong 1975). The normal at a corner is the sum of the
// normals of those triangles around it that continue this one smoothly, with weights that are exact for vertices on a
// sphere (Max 1999). At edges and vertices it is the pseudonormal. Zero if there is no normal.
Vector smooth_normal(const Surface& surface, const SurfacePlace& place, double cosine);

}  // namespace orchard::detail
