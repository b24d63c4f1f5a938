#pragma once
#include <array>
#include <utility>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Returns for each vertex the lowest vertex at the same place.
std::vector<Index> first_at_place(const TriangleMesh& mesh);

// Returns the corners rotated so that the lowest comes first, in ascending order, and whether the other two had to be
// swapped for that.
std::pair<std::array<Index, 3>, bool> canonical(std::array<Index, 3> corners);

// Returns lists, in ascending order, of triangles with the same three corners. It does not need the vertices.
std::vector<std::vector<Index>> same_corners(const TriangleMesh& mesh);

}  // namespace orchard
