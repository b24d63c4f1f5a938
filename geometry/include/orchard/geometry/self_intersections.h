#pragma once
#include <array>
#include <vector>

#include "orchard/geometry/mesh.h"

// Finds where a mesh cuts itself.
namespace orchard {

// Returns the pairs of triangles that meet outside the corners and edges that they share: those that cut, touch or
// overlap each other. Corners at the same place count as shared, whatever their numbers. Triangles without area and
// triangles on the same three places are other faults and are ignored.
// Each pair is ascending, and pairs are in lexicographic order. The result is exact (CGAL's predicates). Precondition:
// validate(mesh) passes. O(n log n + k) for k pairs of overlapping boxes.
std::vector<std::array<Index, 2>> self_intersections(const TriangleMesh& mesh);

}  // namespace orchard
