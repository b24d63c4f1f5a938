#include "solid_parts.h"

namespace orchard::detail {
namespace {

void flood(const Surface& surface, Index start, Index part, std::vector<Index>& of_triangle) {
  std::vector<Index> open{start};
  of_triangle[start] = part;
  while (!open.empty()) {
    const Index triangle = open.back();
    open.pop_back();
    for (const Index next : surface.neighbors(triangle)) {
      if (next == kNone || of_triangle[next] != kNone) continue;
      of_triangle[next] = part;
      open.push_back(next);
    }
  }
}

}  // namespace

bool SolidParts::all_balls() const {
  for (Index part = 0; part < count(); ++part) {
    if (!(volume[part] > 0) || euler_characteristic[part] != 2) return false;
  }
  return true;
}

SolidParts find_solid_parts(const Surface& surface) {
  const TriangleMesh& mesh = surface.mesh();
  const Index size = static_cast<Index>(mesh.triangles.size());
  SolidParts parts;
  parts.of_triangle.assign(size, kNone);
  std::vector<std::uint8_t> counted(mesh.vertices.size(), 0);
  std::vector<std::int64_t> half_edges;
  const Point& origin = surface.bounding_ball().center;
  for (Index triangle = 0; triangle < size; ++triangle) {
    if (parts.of_triangle[triangle] == kNone) {
      flood(surface, triangle, parts.count(), parts.of_triangle);
      parts.volume.push_back(0);
      parts.euler_characteristic.push_back(0);
      half_edges.push_back(0);
    }
    const Index part = parts.of_triangle[triangle];
    const auto [a, b, c] = surface.corners(triangle);
    parts.volume[part] += (a - origin).dot((b - origin).cross(c - origin)) / 6;
    ++parts.euler_characteristic[part];
    half_edges[part] += 3;
    for (const Index vertex : mesh.triangles[triangle]) {
      if (counted[vertex]) continue;
      counted[vertex] = 1;
      ++parts.euler_characteristic[part];
    }
  }
  for (Index part = 0; part < parts.count(); ++part) parts.euler_characteristic[part] -= half_edges[part] / 2;
  return parts;
}

}  // namespace orchard::detail
