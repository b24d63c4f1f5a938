#pragma once
#include "orchard/medial/thickness.h"

namespace orchard::detail {

// The outward unit normal at a place of the smooth surface that a mesh stands for, whose neighbouring facets turn by
// less than an angle of the given cosine. On faces it is interpolated between the normals at the corners (Phong 1975),
// each of which is the sum of those of the triangles around that turn by less from this one, weighted so that it is
// right for vertices on a sphere (Max 1999). At edges and vertices it is the pseudonormal. Zero where there is none.
Vector smooth_normal(const Surface& surface, const SurfacePlace& place, double cosine);

}  // namespace orchard::detail
