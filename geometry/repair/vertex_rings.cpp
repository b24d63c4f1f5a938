#include "repair/vertex_rings.h"

#include <algorithm>
#include <numeric>

namespace orchard {
namespace {

Rows triangles_at_vertices(const TriangleMesh& mesh) {
  Rows rows;
  rows.offsets.assign(mesh.vertices.size() + 1, 0);
  for (const auto& triangle : mesh.triangles)
    for (const Index corner : triangle) ++rows.offsets[corner + 1];
  std::partial_sum(rows.offsets.begin(), rows.offsets.end(), rows.offsets.begin());
  rows.items.resize(3 * mesh.triangles.size());
  std::vector<Index> end(rows.offsets.begin(), rows.offsets.end() - 1);
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (const Index corner : mesh.triangles[t]) rows.items[end[corner]++] = t;
  return rows;
}

}  // namespace

VertexRings::VertexRings(const TriangleMesh& given) : mesh(given), triangles_at(triangles_at_vertices(given)) {}

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
