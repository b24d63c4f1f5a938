#include "repair_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "neck_test.h"
#include "orchard/geometry/tolerance.h"
#include "valley_bottom.h"

namespace orchard::detail {
namespace {

constexpr int kMaxWalk = 1000;
// In gap widths: if the bottom of a V is farther away than this, its sides count as parallel.
constexpr double kNearBottom = 4;
// The least cosine of the angle between a projection's direction and the surface's normal at its end: 25 degrees.
constexpr double kAlongNormal = 0.9;
// Fraction of the bounding radius: a projection farther than this from the surface is not on it.
constexpr double kFreeFloating = 1e-10;

// The point of the triangle nearest to `position`, with its feature and its distance from `from`.
ClosestPoint place_on(const Surface& surface, Index triangle, const Point& position, const Point& from) {
  const auto [a, b, c] = surface.corners(triangle);
  ClosestPoint place = closest_point_of_triangle(position, a, b, c);
  place.triangle = triangle;
  place.distance = (place.position - from).norm();
  return place;
}

ClosestPoint nearest_of_component(const Surface& surface, const RestrictedVoronoi& restricted,
                                  const CellComponent& component) {
  const Point& from = restricted.points()[component.cell];
  ClosestPoint nearest;
  nearest.distance = std::numeric_limits<double>::infinity();
  CellPolygon polygon;
  for (const Index triangle : component.triangles) {
    restricted.polygon(triangle, component.cell, polygon);
    for (std::size_t i = 2; i < polygon.corners.size(); ++i) {
      const ClosestPoint found =
          closest_point_of_triangle(from, polygon.corners[0], polygon.corners[i - 1], polygon.corners[i]);
      if (!(found.distance < nearest.distance)) continue;
      nearest = found;
      nearest.triangle = triangle;
    }
  }
  return place_on(surface, nearest.triangle, nearest.position, from);
}

class Projector {
 public:
  Projector(const Surface& surface, const RestrictedVoronoi& restricted, const CellComponent& component)
      : surface_(surface), restricted_(restricted), component_(component), from_(restricted.points()[component.cell]) {}

  // `target`, which lies in the plane of the triangle's cluster, if it is a point of the cluster.
  std::optional<ClosestPoint> within_cluster(const Point& target, Index triangle) const {
    const ClosestPoint found = surface_.closest(target);
    if (!(found.distance <= kFreeFloating * surface_.bounding_radius())) return std::nullopt;
    std::vector<Index> around;
    surface_.triangles_at(found.triangle, found.feature, around);
    const auto& cluster = surface_.clusters().of_triangle;
    for (const Index other : around) {
      if (cluster[other] == cluster[triangle]) return place_on(surface_, found.triangle, found.position, from_);
    }
    return std::nullopt;
  }

  // Walks from triangle `start` over nearly flat edges as long as the distance to `target` falls. Returns nothing if
  // the walk enters another component of the cell, or if the way to its end is too far from the surface's normal there.
  std::optional<ClosestPoint> walk(const Point& target, Index start) const {
    ClosestPoint at = nearest_on(start, target);
    std::vector<Index> around;
    for (int step = 0; step < kMaxWalk; ++step) {
      if (in_other_component(at.triangle)) return std::nullopt;
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
    at.distance = across.norm();
    return at;
  }

 private:
  ClosestPoint nearest_on(Index triangle, const Point& target) const {
    const auto [a, b, c] = surface_.corners(triangle);
    ClosestPoint found = closest_point_of_triangle(target, a, b, c);
    found.triangle = triangle;
    return found;
  }
  bool in_other_component(Index triangle) const {
    return restricted_.piece(triangle, component_.cell) != nullptr &&
           !std::binary_search(component_.triangles.begin(), component_.triangles.end(), triangle);
  }

  const Surface& surface_;
  const RestrictedVoronoi& restricted_;
  const CellComponent& component_;
  const Point from_;
};

// The mirror image of a point with normal `own` in a bisector of two planes: its tangent plane and the plane through
// `other` with normal `normal`. Of the two bisectors, the one on which the signed distances from both are equal.
std::optional<Point> straight_across(const Point& from, const Vector& own, const Point& other, const Vector& normal) {
  const Vector direction = own - normal;
  const double squared = direction.squaredNorm();
  if (!(squared > 1)) return std::nullopt;  // the planes face the same way within 60 degrees: nothing lies across
  const double offset = normal.dot(other - from);
  return from - (2 * offset / squared) * direction;
}

// Of the triangles that a sample lies on, the normal that is most nearly opposite to `normal`.
Vector facing_normal(const Surface& surface, const SurfaceSampling& sampling, Index cell, const Vector& normal) {
  std::vector<Index> around;
  surface.triangles_at(sampling.triangles[cell], sampling.features[cell], around);
  Vector best = surface.normal(around[0]);
  for (const Index triangle : around) {
    if (surface.normal(triangle).dot(normal) < best.dot(normal)) best = surface.normal(triangle);
  }
  return best;
}

}  // namespace

RepairProposal propose_repair(const Surface& surface, const SurfaceSampling& sampling,
                              const RestrictedVoronoi& restricted, const Crossing& crossing, bool bounced) {
  const CellComponent& component = crossing.component;
  const Point& from = restricted.points()[component.cell];
  RepairProposal proposal;
  if (crossing.neck) {
    const bool disk = component.euler_characteristic == 1 && !crossing.neighbors.empty();
    const auto [position, triangle] = farthest_corner(restricted, component, disk ? crossing.neighbors[0] : kNone);
    proposal.snapped = place_on(surface, triangle, position, from);
    return proposal;
  }
  proposal.snapped = nearest_of_component(surface, restricted, component);
  const Index met = proposal.snapped.triangle;
  const auto propose = [&](const std::optional<ClosestPoint>& place) {
    if (place) proposal.facing.push_back(*place);
  };
  if (bounced) {
    const double reach = kNearBottom * proposal.snapped.distance;
    propose(bottom_of_valley(surface, sampling, component.cell, met, reach));
    if (!proposal.facing.empty() && proposal.facing[0].distance > reach) proposal.facing.clear();
  }
  const Projector projector(surface, restricted, component);
  const Vector& normal = surface.normal(met);
  const Vector own = facing_normal(surface, sampling, component.cell, normal);
  const std::optional<Point> mirrored = straight_across(from, own, proposal.snapped.position, normal);
  const Point projection = from - normal * normal.dot(from - proposal.snapped.position);
  if (mirrored) propose(projector.within_cluster(*mirrored, met));
  if (proposal.facing.empty()) propose(projector.within_cluster(projection, met));
  if (proposal.facing.empty() && mirrored) propose(projector.walk(*mirrored, met));
  if (proposal.facing.empty()) propose(projector.walk(from, met));
  return proposal;
}

}  // namespace orchard::detail
