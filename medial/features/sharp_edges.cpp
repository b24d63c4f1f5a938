#include "sharp_edges.h"

#include <algorithm>

#include "orchard/geometry/angle.h"

namespace orchard::detail {
namespace {

// How far an edge between two places may be from the middle of the way between them, as a part of this way. Around a
// corner of 120 degrees it is just as far.
constexpr double kMaxMiddleDistance = 0.25;

}  // namespace

template <class Visit>
void SharpEdges::visit_near(const Point& place, double far, const Visit& visit) {
  surface_.triangles_near({place, far}, near_);
  for (const Index triangle : near_) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index other = surface_.neighbors(triangle)[i];
      if (other == kNone || other < triangle) continue;
      if (features_.has(triangle, i)) visit(triangle, i);
    }
  }
}

template <class PlaceOnEdge>
bool SharpEdges::search(const Point& place, double far, ClosestPoint& found, PlaceOnEdge&& place_on_edge) {
  double min = far;
  visit_near(place, far, [&](Index triangle, std::size_t i) {
    const auto corners = surface_.corners(triangle);
    const Vector edge = corners[(i + 1) % 3] - corners[i];
    const Point at = corners[i] + place_on_edge((place - corners[i]).dot(edge) / edge.squaredNorm()) * edge;
    if (!((at - place).norm() < min)) return;
    min = (at - place).norm();
    found = closest_point_of_triangle(at, corners[0], corners[1], corners[2]);
    found.triangle = triangle;
    found.distance = 0;
  });
  return min < far;
}

void SharpEdges::all_at(const Point& place, double far, std::vector<std::array<Index, 2>>& found) {
  found.clear();
  visit_near(place, far, [&](Index triangle, std::size_t i) {
    const auto corners = surface_.corners(triangle);
    const Vector edge = corners[(i + 1) % 3] - corners[i];
    const double t = std::clamp((place - corners[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    if ((corners[i] + t * edge - place).norm() > far) return;
    const auto& vertices = surface_.mesh().triangles[triangle];
    found.push_back({std::min(vertices[i], vertices[(i + 1) % 3]), std::max(vertices[i], vertices[(i + 1) % 3])});
  });
}

bool SharpEdges::goes_between(const Point& a, const Point& b) {
  ClosestPoint found{.position = Point::Zero()};
  return a == b || nearest(0.5 * (a + b), kMaxMiddleDistance * (a - b).norm(), found);
}

bool SharpEdges::nearest(const Point& place, double far, ClosestPoint& found) {
  return search(place, far, found, [](double t) { return std::clamp(t, 0.0, 1.0); });
}

bool SharpEdges::nearest_end(const Point& place, double far, ClosestPoint& found) {
  return search(place, far, found, [](double t) { return t < 0.5 ? 0.0 : 1.0; });
}

}  // namespace orchard::detail
