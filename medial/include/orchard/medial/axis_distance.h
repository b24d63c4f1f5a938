#pragma once
#include "orchard/medial/medial_mesh.h"

// Compares two medial meshes by their distance.
namespace orchard {

// The distance between two medial meshes as sets of centres: their vertices, edges and triangles without the radii.
// Lengths are in mesh units.
struct AxisDistance {
  double max = 0;      // A lower bound on the two-sided Hausdorff distance.
  double max_gap = 0;  // The distance is at most max + max_gap.
  // The mean of the two one-sided mean distances. Each is taken over the area of the triangles of one mesh, or over the
  // length of its edges or over its vertices if it has no triangles.
  double mean = 0;
  // The two one-sided maxima: from places of the first mesh to the second mesh, and the other way.
  double max_from = 0, max_to = 0;
};

// Measures the distance of two medial meshes. The maximum is found by branch and bound, since the distance to a set is
// 1-Lipschitz. The search ends when the maximum is known to `accuracy` (mesh units, above 0) or after a million places.
// Precondition: validate() passes for both meshes. Throws InputError unless accuracy > 0. The result is deterministic.
// Takes O(n log n), and several queries for each cell.
AxisDistance axis_distance(const MedialMesh& a, const MedialMesh& b, double accuracy);

}  // namespace orchard
