#include "valley_bottom.h"

#include <algorithm>

namespace orchard::detail {

std::optional<ClosestPoint> bottom_of_valley(const Surface& surface, const SurfaceSampling& sampling, Index cell,
                                             Index triangle, double reach) {
  const auto& cluster_of = surface.clusters().of_triangle;
  std::vector<Index> own;
  surface.triangles_at(sampling.triangles[cell], sampling.features[cell], own);
  for (Index& at : own) at = cluster_of[at];
  const auto touches_own = [&](Index vertex) {
    const auto around = surface.triangles_around(vertex);
    return std::any_of(around.begin(), around.end(), [&](Index other) {
      return cluster_of[other] != cluster_of[triangle] &&
             std::find(own.begin(), own.end(), cluster_of[other]) != own.end();
    });
  };
  std::optional<ClosestPoint> vertex, edge;
  const auto consider = [&](std::optional<ClosestPoint>& best, Index on, const Point& a, const Point& b) {
    ClosestPoint found = closest_point_of_triangle(sampling.points[cell], a, b, b);
    if (best && !(found.distance < best->distance)) return;
    const auto [p, q, r] = surface.corners(on);
    found.feature = closest_point_of_triangle(found.position, p, q, r).feature;
    found.triangle = on;
    best = found;
  };
  for (const Index on : surface.clusters().triangles[cluster_of[triangle]]) {
    const auto corners = surface.corners(on);
    for (unsigned k = 0; k < 3; ++k) {
      if (touches_own(surface.mesh().triangles[on][k])) consider(vertex, on, corners[k], corners[k]);
      const Index across = surface.neighbors(on)[k];
      if (across == kNone || std::find(own.begin(), own.end(), cluster_of[across]) == own.end()) continue;
      if (cluster_of[across] != cluster_of[triangle]) consider(edge, on, corners[k], corners[(k + 1) % 3]);
    }
  }
  return vertex && vertex->distance <= reach ? vertex : edge;
}

}  // namespace orchard::detail
