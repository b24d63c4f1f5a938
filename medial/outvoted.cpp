#include "outvoted.h"

#include <algorithm>

#include "orchard/geometry/self_intersections.h"

namespace orchard::detail {
namespace {

// Cosine between the surface's normal at a point and the direction to a vertex that it faces: 60 degrees.
constexpr double kFaces = 0.5;

bool outvoted(const VoronoiDiagram& diagram, std::span<const Vector> normals, const VoronoiVertex& vertex) {
  const auto faces = [&](Index point) {
    return normals[point].dot(vertex.center - diagram.points[point]) > kFaces * vertex.radius;
  };
  return std::count_if(vertex.forming_points.begin(), vertex.forming_points.end(), faces) >= 3;
}

}  // namespace

void drop_outvoted(const Surface& surface, std::span<const Vector> normals, const VoronoiDiagram& diagram,
                   std::vector<std::uint8_t>& inside) {
  std::vector<Index> candidates;
  for (Index i = 0; i < inside.size(); ++i) {
    if (inside[i] && outvoted(diagram, normals, diagram.vertices[i])) candidates.push_back(i);
  }
  if (candidates.empty() || self_intersections(surface.mesh()).empty()) return;
  for (const Index vertex : candidates) inside[vertex] = 0;
}

}  // namespace orchard::detail
