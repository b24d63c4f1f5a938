#pragma once
#include <array>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

class TriangleTree;

// Does the same as the public self_intersections(), for a mesh whose tree already exists.
std::vector<std::array<Index, 2>> self_intersections(const TriangleMesh& mesh, const TriangleTree& tree);

}  // namespace orchard::detail
