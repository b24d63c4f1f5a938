#include "triangle_shape.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace orchard::detail {
namespace {

// The heights of the triangles at an edge are the vectors from the edge to their opposite corners, at right angles to
// the edge.
double flatness_at(const SheetMesh& mesh, Index a, Index b, std::span<const Index> opposite,
                   std::vector<Vector>& heights) {
  const Vector along = (mesh.center(b) - mesh.center(a)).normalized();
  heights.clear();
  for (const Index c : opposite) {
    const Vector side = mesh.center(c) - mesh.center(a);
    const Vector height = side - side.dot(along) * along;
    heights.push_back(height.squaredNorm() > 0 ? height.normalized() : height);
  }
  double worst = 1;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) worst = std::min(worst, -heights[i].dot(heights[k]));
  }
  return worst;
}

}  // namespace

double triangle_quality(const SheetMesh& mesh, const SheetMesh::Cell& cell) {
  return triangle_quality(mesh.center(cell[0]), mesh.center(cell[1]), mesh.center(cell[2]));
}

double worst_quality(const SheetMesh& mesh, std::span<const Index> cells) {
  double worst = 1;
  for (const Index c : cells) {
    if (is_triangle(mesh.corners(c))) worst = std::min(worst, triangle_quality(mesh, mesh.corners(c)));
  }
  return worst;
}

Flatness worst_flatness(const SheetMesh& mesh, std::span<const Index> cells) {
  std::vector<Index> opposite;
  std::vector<Vector> heights;
  Flatness worst;
  for (const Index c : cells) {
    const SheetMesh::Cell& cell = mesh.corners(c);
    if (!is_triangle(cell)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = cell[i], b = cell[(i + 1) % 3];
      mesh.opposite(a, b, opposite);
      double& kind = opposite.size() > 2 ? worst.at_seams : worst.in_sheets;
      kind = std::min(kind, flatness_at(mesh, a, b, opposite, heights));
    }
  }
  return worst;
}

}  // namespace orchard::detail
