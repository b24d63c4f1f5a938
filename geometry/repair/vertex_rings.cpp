#include "repair/vertex_rings.h"

#include <algorithm>

#include "half_edges.h"

namespace orchard {
VertexRings::VertexRings(const TriangleMesh& given) : mesh(given), triangles_at(triangles_around_vertices(given)) {}

std::vector<Index> VertexRings::two_rings(Index vertex, std::size_t limit) const {
  std::vector<Index> found{vertex};
  for (std::size_t ring = 0, first = 0; ring < 2; ++ring) {
    const std::size_t last = found.size();
    for (; first < last; ++first)
      for (const Index triangle : triangles_at[found[first]])
        for (const Index corner : mesh.triangles[triangle]) {
          if (found.size() == limit) return found;
          if (std::find(found.begin(), found.end(), corner) == found.end()) found.push_back(corner);
        }
  }
  return found;
}

double diagonal_of(const TriangleMesh& mesh) {
  Box box;
  for (const Point& vertex : mesh.vertices) box.extend(vertex);
  return box.diagonal().norm();
}

}  // namespace orchard
