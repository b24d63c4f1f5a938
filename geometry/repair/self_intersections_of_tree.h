#pragma once
#include <array>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

class TriangleTree;

// As the public one, where the mesh's tree is there already.
std::vector<std::array<Index, 2>> self_intersections(const TriangleMesh& mesh, const TriangleTree& tree);

}  // namespace orchard::detail
