#include "offset_bound.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "../quality/max_over_triangles.h"

namespace orchard::detail {
namespace {

// larger than the rounding error of a closest point, as a fraction of the coordinates
constexpr double kOffsetRounding = 1e-13;

Point middle_of(const Corners& corners) { return (corners[0] + corners[1] + corners[2]) / 3; }

double reach_of(const Corners& corners, const Point& middle) {
  double reach = 0;
  for (const Point& corner : corners) reach = std::max(reach, (corner - middle).norm());
  return reach;
}

ClosestPoint closest_in(const Surface& surface, Index triangle, const Point& query) {
  const auto& [a, b, c] = surface.corners(triangle);
  return closest_point_of_triangle(query, a, b, c);
}

PieceValue farthest_of(const Surface& surface, const Corners& corners) {
  const Point middle = middle_of(corners);
  const ClosestPoint closest = surface.closest(middle);
  double to_one_triangle = 0;
  for (const Point& corner : corners)
    to_one_triangle = std::max(to_one_triangle, closest_in(surface, closest.triangle, corner).distance);
  return {.value = closest.distance,
          .bound = std::min(to_one_triangle, closest.distance + reach_of(corners, middle)),
          .place = middle};
}

// The smallest distance with its sign changed, because the search looks for a maximum.
PieceValue nearest_of(const Surface& surface, const Corners& corners, double enough) {
  const Point middle = middle_of(corners);
  const double distance = surface.distance(middle), reach = reach_of(corners, middle);
  double least = std::max(0.0, distance - reach);
  PieceValue result{.value = -distance, .bound = -least, .place = middle};
  if (result.bound <= enough) return result;
  thread_local std::vector<Index> near;
  surface.triangles_near({middle, distance + 2 * reach}, near);
  double bound = distance + reach;  // upper bound for all triangles that are not near
  for (const Index triangle : near) {
    const ClosestPoint closest = closest_in(surface, triangle, middle);
    if (!(closest.distance > 0)) return result;
    const Vector away = (middle - closest.position) / closest.distance;
    double lowest = 0;
    for (const Point& corner : corners) lowest = std::min(lowest, away.dot(corner - middle));
    bound = std::min(bound, closest.distance + lowest);
  }
  result.bound = -std::max(least, bound);
  return result;
}

}  // namespace

DistanceRange distance_range(const TriangleMesh& mesh, const Surface& surface, double accuracy, std::size_t max_parts) {
  std::vector<Corners> triangles;
  Box box = surface.bounding_box();
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  for (const Point& vertex : mesh.vertices) box.extend(vertex);
  const double rounding = kOffsetRounding * (box.min().cwiseAbs().maxCoeff() + box.max().cwiseAbs().maxCoeff());
  const MaxOverTriangles nothing{.max = -std::numeric_limits<double>::infinity(), .upper = 0, .place = Point::Zero()};
  const MaxOverTriangles far =
      max_over_triangles(triangles, nothing, accuracy, max_parts,
                         [&](const Corners& corners, Index, double) { return farthest_of(surface, corners); });
  const MaxOverTriangles near = max_over_triangles(
      triangles, nothing, accuracy, max_parts,
      [&](const Corners& corners, Index, double enough) { return nearest_of(surface, corners, enough); });
  return {.min = std::max(0.0, -near.upper - rounding),
          .max = far.upper + rounding,
          .nearest = near.place,
          .farthest = far.place};
}

}  // namespace orchard::detail
