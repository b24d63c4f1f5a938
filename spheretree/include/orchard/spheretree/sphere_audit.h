#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/union_volume.h"

// Measures how well any set of spheres stands for a surface or a solid.
namespace orchard {

// The options of audit_spheres().
struct SphereAuditOptions {
  // The width of the bounds on the open area, as a fraction of that area.
  double area_tolerance = 2e-3;
  // The maximum number of pieces of triangles that are examined. If it is reached, the bounds are wider.
  Index max_cells = 200'000;
  std::uint64_t rays = 40'000;     // Rays of union_volume().
  Index surface_samples = 20'000;  // Samples of the surface, for mean distances.
  // Samples of the union's boundary, for mean distances, divided among the spheres by their areas.
  Index sphere_samples = 40'000;
  std::uint64_t seed = 1;  // The seed of the samples.
};

// Mean distances from samples, in mesh units.
struct MeanDistances {
  double gap = 0;               // From the surface to the union: 0 where it is covered.
  double protrusion = 0;        // From the union's boundary to the solid: 0 where the boundary lies in it.
  double outside_share = 0;     // The share of the union's boundary area that lies outside the solid.
  double boundary_area = 0;     // The area of the union's boundary, in squared mesh units.
  double surface_to_union = 0;  // From the surface to the union's boundary, from either side.
  double union_to_surface = 0;  // From the union's boundary to the surface, from either side.
  double two_sided() const { return (surface_to_union + union_to_surface) / 2; }
};

// The measures that cuRobo reports of a fit, by the definitions of its public source (sphere_fit/metrics, version 0.8).
// Lengths are in mesh units.
struct CuroboFigures {
  Index num_spheres = 0;
  double coverage = 0;  // The share of the solid's volume that lies in a sphere.
  // The share of sampled points on spheres that lie outside the solid. Each sphere has the same number of points, and
  // those inside other spheres count, too.
  double protrusion = 0;
  double protrusion_dist_mean = 0;  // The mean distance of these points to the surface.
  double protrusion_dist_p95 = 0;   // The 95th percentile of this distance.
  double surface_gap_mean = 0;      // The distance of the surface from the union, 0 where it is covered.
  double surface_gap_p95 = 0;
  double max_uncovered_gap = 0;  // The largest sampled distance.
  // The sum of the spheres' volumes, in which overlaps count as often as they occur, over the volume of the solid.
  double volume_ratio = 0;
};

// The measures of a set of balls against a surface.
struct SphereAudit {
  Index spheres = 0;
  bool covered = false;  // Proven: every point of the surface lies in a ball.
  bool touches = false;  // Some ball contains a point of the surface or lies in the solid.
  double area = 0;       // The area of the surface, in squared mesh units.
  // Proven bounds on the area of the points of the surface that lie in no ball, in squared mesh units.
  Bounds open_area;
  double likely_open_area = 0;
  // Proven bounds on the largest distance of a point of the surface from the union, in mesh units.
  Bounds largest_gap;
  Point gap_place = Point::Zero();  // A place whose distance is largest_gap.lower.
  // Measures that exist only if surface.solid().
  struct BesideSolid {
    // Proven bounds on the largest distance of a point of the union from the solid, in mesh units.
    Bounds protrusion;
    Index protruding = kNone;  // The ball that protrudes farthest.
    UnionVolume volume;
    MeanDistances mean;
    CuroboFigures curobo;
  };
  std::optional<BesideSolid> beside_solid;

  // Returns whether the only gaps are between spheres that meet without overlapping, which computation cannot
  // distinguish from no gap: no gap is wider than tolerance::kTangent times `bounding_radius` (mesh units).
  bool only_tangent(double bounding_radius) const;
};

// Returns the distance of a point from the union of balls, in mesh units. Inside, it is minus the largest depth in a
// single ball. Without any ball, it is infinity. O(n).
double gap_from(std::span<const Sphere> balls, const Point& point);

// Measures any set of balls against a surface, without assumptions about their origin.
// - The boundary lemma decides on each triangle whether the surface is covered.
// - Open area and largest gap are found by halving triangles until the lemma or a distance decides each piece.
// - The protrusion is found by branch and bound over each ball, volumes by rays, and means by samples.
// Throws InputError if there is no ball, or one whose radius is not positive and finite or whose centre is not finite.
// The result is deterministic. A set of 60 balls against 2,000 triangles takes about a second, and one of 2,000 balls
// about ten times as long.
SphereAudit audit_spheres(const Surface& surface, std::span<const Sphere> balls, const SphereAuditOptions& options = {},
                          const Progress& progress = {});

}  // namespace orchard
