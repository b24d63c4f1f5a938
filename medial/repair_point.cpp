#include "repair_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

constexpr int kMaxWalk = 1000;
// Cosine between the direction of a projection and the surface's normal at its end: 25 degrees.
constexpr double kAlongNormal = 0.9;

ClosestPoint closest_of_patch(const Surface& surface, const RestrictedVoronoi& restricted, const CellPatch& patch,
                              const Point& query) {
  ClosestPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  CellPolygon polygon;
  for (const Index triangle : patch.triangles) {
    restricted.polygon(triangle, patch.cell, polygon);
    for (std::size_t i = 2; i < polygon.corners.size(); ++i) {
      ClosestPoint found =
          closest_point_of_triangle(query, polygon.corners[0], polygon.corners[i - 1], polygon.corners[i]);
      if (found.distance < best.distance) {
        best = found;
        best.triangle = triangle;
      }
    }
  }
  const auto [a, b, c] = surface.corners(best.triangle);
  const Index triangle = best.triangle;
  const double distance = best.distance;
  best = closest_point_of_triangle(best.position, a, b, c);  // back onto the triangle, with its feature
  best.triangle = triangle;
  best.distance = distance;
  return best;
}

class Projector {
 public:
  Projector(const Surface& surface, const Point& from, const CellPatch* home)
      : surface_(surface), from_(from), home_(home), slack_(tolerance::kOnTriangle * surface.bounding_radius()) {}

  // `target`, which lies in the plane of the cluster, if the cluster holds it.
  std::optional<ClosestPoint> within_cluster(const Point& target, Index triangle) const {
    ClosestPoint found = surface_.closest(target);
    if (!(found.distance <= 100 * slack_)) return std::nullopt;
    std::vector<Index> around;
    surface_.triangles_at(found.triangle, found.feature, around);
    const auto& cluster = surface_.clusters().of_triangle;
    for (const Index other : around) {
      if (cluster[other] == cluster[triangle]) return found;
    }
    return std::nullopt;
  }

  // Downhill on the distance to `target`, over edges that are all but flat.
  std::optional<ClosestPoint> walk(const Point& target, const ClosestPoint& start) const {
    ClosestPoint at = nearest_on(start.triangle, target);
    std::vector<Index> around;
    for (int step = 0; step < kMaxWalk; ++step) {
      if (at_home(at.triangle)) return std::nullopt;
      surface_.triangles_at(at.triangle, at.feature, around);
      ClosestPoint best = at;
      for (const Index next : around) {
        if (surface_.normal(next).dot(surface_.normal(at.triangle)) < tolerance::kFlatEdgeCosine) continue;
        const ClosestPoint found = nearest_on(next, target);
        if (found.distance < best.distance) best = found;
      }
      if (best.triangle == at.triangle) break;
      at = best;
    }
    const Vector across = from_ - at.position;
    const double along = std::abs(surface_.pseudonormal(at.triangle, at.feature).dot(across));
    if (!(along > kAlongNormal * across.norm())) return std::nullopt;
    return at;
  }

 private:
  ClosestPoint nearest_on(Index triangle, const Point& target) const {
    const auto [a, b, c] = surface_.corners(triangle);
    ClosestPoint found = closest_point_of_triangle(target, a, b, c);
    found.triangle = triangle;
    return found;
  }
  bool at_home(Index triangle) const {
    return home_ != nullptr && std::binary_search(home_->triangles.begin(), home_->triangles.end(), triangle);
  }

  const Surface& surface_;
  const Point from_;
  const CellPatch* home_;
  double slack_;
};

// The mirror image of a point with normal `own` in the bisector of its tangent plane and the plane through `other` with
// normal `normal`: the one on which both planes' signed distances agree.
std::optional<Point> straight_across(const Point& from, const Vector& own, const Point& other, const Vector& normal) {
  const Vector direction = own - normal;
  const double squared = direction.squaredNorm();
  if (!(squared > 1)) return std::nullopt;  // the planes face the same way within 60 degrees: nothing lies across
  const double offset = normal.dot(other - from);
  return from - (2 * offset / squared) * direction;
}

}  // namespace

RepairPoint propose_repair(const Surface& surface, const SurfaceSampling& sampling, const RestrictedVoronoi& restricted,
                           const CellPatch& patch, const CellPatch* home, Across across) {
  const Point& from = restricted.points()[patch.cell];
  const ClosestPoint nearest = closest_of_patch(surface, restricted, patch, from);
  const Vector& normal = surface.normal(nearest.triangle);
  Point target = from - normal * normal.dot(from - nearest.position);
  if (across == Across::straight) {
    const Vector own = surface.pseudonormal(sampling.triangles[patch.cell], sampling.features[patch.cell]);
    if (const auto mirrored = straight_across(from, own, nearest.position, normal)) target = *mirrored;
  }
  const Projector projector(surface, from, home);
  std::optional<ClosestPoint> found = projector.within_cluster(target, nearest.triangle);
  if (!found) found = projector.walk(across == Across::straight ? target : from, nearest);
  RepairPoint result;
  result.cell = patch.cell;
  result.snapped = !found;
  const ClosestPoint& chosen = found ? *found : nearest;
  result.position = chosen.position;
  result.triangle = chosen.triangle;
  result.feature = chosen.feature;
  result.gap = (chosen.position - from).norm();
  return result;
}

}  // namespace orchard::detail
