#pragma once
#include <array>
#include <vector>

#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// Divides the edges of a medial mesh at their middles, and its triangles with them, until no edge is longer than
// `length` (mesh units, above 0). The result is complete and covers the same places with the same interpolated radii.
// Vertices of the mesh come first, in their order. O(n) for n triangles of the result.
MedialMesh divided(const MedialMesh& mesh, double length);

// Returns the edge length, at least `wanted`, for which divided() makes about two million triangles at most.
double affordable_edge_length(const MedialMesh& mesh, double wanted);

}  // namespace orchard::detail
