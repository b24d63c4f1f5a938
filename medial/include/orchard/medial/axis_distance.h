#pragma once
#include "orchard/medial/medial_mesh.h"

namespace orchard {

// How far apart two medial meshes are, as sets of centres: their vertices, edges and triangles, without the radii.
struct AxisDistance {
  double max = 0;      // two-sided Hausdorff distance, in mesh units, never too large
  double max_gap = 0;  // by how much more it may be
  // Mean of the two means: over the area of the triangles of either (over the length of its edges or over its vertices
  // where it has none).
  double mean = 0;
  double max_from = 0, max_to = 0;  // the two one-sided maxima: of places of the first from the second, and back
};

// The maximum is searched by branch and bound, the distance to a set being 1-Lipschitz, until it is known to `accuracy`
// (mesh units, above 0) or a million places have been looked at. O(n log n) and some queries a cell; deterministic.
// Precondition: validate() passes for both. Throws InputError unless accuracy > 0.
AxisDistance axis_distance(const MedialMesh& a, const MedialMesh& b, double accuracy);

}  // namespace orchard
