#pragma once
#include <array>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Pairs of triangles that meet elsewhere than in corners and edges that they share: those that cut, touch or overlap
// each other. Corners in the same place are shared, whatever their numbers. Triangles without area and triangles on the
// same three places are other faults and take no part. Each pair ascending, pairs in lexicographic order; exact (CGAL's
// predicates). O(n log n + k) for k pairs of overlapping boxes. Precondition: validate(mesh) passes.
std::vector<std::array<Index, 2>> self_intersections(const TriangleMesh& mesh);

}  // namespace orchard
