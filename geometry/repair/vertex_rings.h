#pragma once
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// The triangles at each vertex of a mesh, in ascending order. It keeps a reference to the mesh.
struct VertexRings {
  explicit VertexRings(const TriangleMesh& mesh);

  // Returns the vertex itself, its neighbours and theirs, in the order in which they are reached, and at most `limit`
  // of them.
  std::vector<Index> two_rings(Index vertex, std::size_t limit) const;

  const TriangleMesh& mesh;
  Rows triangles_at;
};

// Returns the diagonal of the bounding box.
double diagonal_of(const TriangleMesh& mesh);

}  // namespace orchard
