#pragma once
#include <optional>

#include "orchard/geometry/mesh_check.h"

namespace orchard {

// What a look at a mesh adds to check_mesh().
struct MeshDetails {
  Index boundary_loops = 0;           // independent cycles of boundary edges; holes that touch at a vertex are two
  Index duplicate_triangles = 0;      // on the same three places as an earlier one, either way round
  Index coincident_vertices = 0;      // in the same place as an earlier one: a seam, or parts that touch
  std::optional<std::int64_t> genus;  // handles of all components; of closed manifolds only
};

// O(n log n). `report` is check_mesh(mesh). Precondition: validate(mesh) passes.
MeshDetails mesh_details(const TriangleMesh& mesh, const MeshReport& report);

}  // namespace orchard
