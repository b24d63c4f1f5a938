#include "smooth_normal.h"

#include <algorithm>

namespace orchard::detail {
namespace {

Vector normal_at_corner(const Surface& surface, Index triangle, Index vertex, double cosine) {
  const auto& mesh = surface.mesh();
  Vector sum = Vector::Zero();
  for (const Index other : surface.triangles_around(vertex)) {
    if (surface.normal(other).dot(surface.normal(triangle)) < cosine) continue;
    const auto& corners = mesh.triangles[other];
    std::size_t i = 0;
    while (corners[i] != vertex) ++i;
    const Vector next = mesh.vertices[corners[(i + 1) % 3]] - mesh.vertices[vertex],
                 last = mesh.vertices[corners[(i + 2) % 3]] - mesh.vertices[vertex];
    const double weight = next.squaredNorm() * last.squaredNorm();
    if (weight > 0) sum += next.cross(last) / weight;
  }
  return sum.norm() > 0 ? Vector(sum.normalized()) : surface.normal(triangle);
}

}  // namespace

Vector smooth_normal(const Surface& surface, const SurfacePlace& place, double cosine) {
  if (place.feature != Feature::face) return surface.pseudonormal(place.triangle, place.feature);
  const Vector& flat = surface.normal(place.triangle);
  if (flat.isZero(0)) return flat;
  const auto& vertices = surface.mesh().triangles[place.triangle];
  const std::array<Point, 3> corners = surface.corners(place.triangle);
  Vector sum = Vector::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector side = corners[(i + 2) % 3] - corners[(i + 1) % 3];
    const double weight = side.cross(place.position - corners[(i + 1) % 3]).dot(flat);  // of twice the area
    sum += std::max(weight, 0.0) * normal_at_corner(surface, place.triangle, vertices[i], cosine);
  }
  return sum.norm() > 0 ? Vector(sum.normalized()) : flat;
}

}  // namespace orchard::detail
