#pragma once
#include <optional>

#include "orchard/geometry/mesh_check.h"

// Counts of a mesh that check_mesh() does not compute.
namespace orchard {

// Further counts of a mesh.
struct MeshDetails {
  // Independent cycles of boundary edges. Two holes that touch at a vertex are two cycles.
  Index boundary_loops = 0;
  // Triangles with the same three places as an earlier one, in either orientation.
  Index duplicate_triangles = 0;
  // Vertices at the same place as an earlier one, which form a seam or belong to parts that touch.
  Index coincident_vertices = 0;
  // The number of handles of all components. Only closed manifolds have a genus.
  std::optional<std::int64_t> genus;
};

// Computes the counts. `report` is check_mesh(mesh). Precondition: validate(mesh) passes. O(n log n).
MeshDetails mesh_details(const TriangleMesh& mesh, const MeshReport& report);

}  // namespace orchard
