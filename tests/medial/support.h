#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "axis/interior.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"

namespace orchard::test {

inline double diagonal(const Surface& surface) { return surface.bounding_box().diagonal().norm(); }

// The farthest that a segment between adjacent medial vertices leaves the solid, at eight points on each; a fraction of
// the bounding radius, 0 if none does.
inline double farthest_outside(const Surface& surface, const MedialAxis& axis) {
  double farthest = 0;
  for (Index a = 0; a < axis.size(); ++a) {
    for (const Index b : axis.neighbors[a]) {
      if (b < a) continue;
      for (int k = 1; k < 9; ++k) {
        const Point query = axis.centers[a] + k / 9.0 * (axis.centers[b] - axis.centers[a]);
        farthest = std::max(farthest, surface.signed_distance(query));
      }
    }
  }
  return farthest / surface.bounding_radius();
}

// Of the complex that the interior Voronoi vertices make with the edges and faces between them; for points that see the
// solid's topology it is the solid's own, half of its surface's.
inline std::int64_t euler_characteristic(const Surface& surface, const VoronoiDiagram& diagram) {
  const std::vector<std::uint8_t> inside = detail::interior_vertices(surface, diagram);
  std::int64_t sum = 0;
  for (Index i = 0; i < inside.size(); ++i) {
    if (!inside[i]) continue;
    ++sum;
    for (const Index next : diagram.vertices[i].neighbors) sum -= next > i && inside[next] ? 1 : 0;
  }
  const VoronoiFaces faces = voronoi_faces(diagram);
  for (Index face = 0; face < faces.vertices.size(); ++face) {
    const auto corners = faces.vertices[face];
    sum += std::all_of(corners.begin(), corners.end(), [&](Index corner) { return inside[corner] != 0; }) ? 1 : 0;
  }
  return sum;
}

inline Index count_components(const MedialAxis& axis) {
  Index count = 0;
  connected_components(axis, count);
  return count;
}

}  // namespace orchard::test
