#pragma once
#include <array>
#include <utility>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// For each vertex the lowest one at the same place.
std::vector<Index> first_at_place(const TriangleMesh& mesh);

// The corners from the lowest one on, and whether the other two had to be swapped to be in order.
std::pair<std::array<Index, 3>, bool> canonical(std::array<Index, 3> corners);

// Triangles on the same three corners, in lists of ascending number. Needs no vertices.
std::vector<std::vector<Index>> same_corners(const TriangleMesh& mesh);

}  // namespace orchard
