#include "sharp_edges.h"

#include <algorithm>

#include "orchard/geometry/angle.h"

namespace orchard::detail {

template <class PlaceOnEdge>
bool SharpEdges::search(const Point& place, double far, ClosestPoint& found, PlaceOnEdge&& place_on_edge) {
  surface_.triangles_near({place, far}, near_);
  double min = far;
  for (const Index triangle : near_) {
    const auto corners = surface_.corners(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
      const Index other = surface_.neighbors(triangle)[i];
      if (other == kNone || other < triangle) continue;
      const Vector &n = surface_.normal(triangle), &m = surface_.normal(other);
      const Vector edge = corners[(i + 1) % 3] - corners[i];
      if (!(angle_between(n, m) >= angle_) || !(n.cross(m).dot(edge) > 0)) continue;
      const Point at = corners[i] + place_on_edge((place - corners[i]).dot(edge) / edge.squaredNorm()) * edge;
      if (!((at - place).norm() < min)) continue;
      min = (at - place).norm();
      found = closest_point_of_triangle(at, corners[0], corners[1], corners[2]);
      found.triangle = triangle;
      found.distance = 0;
    }
  }
  return min < far;
}

bool SharpEdges::nearest(const Point& place, double far, ClosestPoint& found) {
  return search(place, far, found, [](double t) { return std::clamp(t, 0.0, 1.0); });
}

bool SharpEdges::nearest_end(const Point& place, double far, ClosestPoint& found) {
  return search(place, far, found, [](double t) { return t < 0.5 ? 0.0 : 1.0; });
}

}  // namespace orchard::detail
