#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/union_volume.h"

namespace orchard {

struct SphereAuditOptions {
  double area_tolerance = 2e-3;    // width of the bounds on the open area, as a fraction of that area
  Index max_cells = 200'000;       // pieces of triangles to look at; where they run out, the bounds are wider
  std::uint64_t rays = 40'000;     // of union_volume()
  Index surface_samples = 20'000;  // for mean distances from the surface
  Index sphere_samples = 40'000;   // for mean distances from the union's boundary, shared out by the spheres' areas
  std::uint64_t seed = 1;          // of the samples
};

// Mean distances, from samples, in mesh units.
struct MeanDistances {
  double gap = 0;               // from the surface to the union: 0 where it is covered
  double protrusion = 0;        // from the union's boundary to the solid: 0 where the boundary lies in it
  double outside_share = 0;     // of the union's boundary, by area, that lies outside the solid
  double boundary_area = 0;     // of the union, squared mesh units
  double surface_to_union = 0;  // from the surface to the union's boundary, from either side
  double union_to_surface = 0;  // from the union's boundary to the surface, from either side
  double two_sided() const { return (surface_to_union + union_to_surface) / 2; }
};

// The figures that cuRobo prints of a fit, by the definitions of its public source (sphere_fit/metrics, version 0.8):
// lengths in mesh units.
struct CuroboFigures {
  Index num_spheres = 0;
  double coverage = 0;              // share of the solid's volume in a sphere
  double protrusion = 0;            // share of points on spheres outside the solid, as many for each sphere, those
                                    // inside other spheres counted, too
  double protrusion_dist_mean = 0;  // of these points, the mean distance to the surface
  double protrusion_dist_p95 = 0;   // and the 95th percentile
  double surface_gap_mean = 0;      // distance of the surface from the union, 0 where it is covered
  double surface_gap_p95 = 0;
  double max_uncovered_gap = 0;  // the largest of the sampled ones
  double volume_ratio = 0;  // sum of the spheres' volumes, overlaps counted as often as they occur, over the solid's
};

// What a set of balls is beside a surface.
struct SphereAudit {
  Index spheres = 0;
  bool covered = false;  // proven: every point of the surface lies in a ball
  bool touches = false;  // some ball has a point of the surface, or lies in the solid
  double area = 0;       // of the surface, squared mesh units
  Bounds open_area;      // of the points of the surface in no ball, proven
  double likely_open_area = 0;
  Bounds largest_gap;               // the largest distance of a point of the surface from the union, proven
  Point gap_place = Point::Zero();  // where it is as large as largest_gap.lower
  // Only of a solid, as surface.solid() has it:
  struct BesideSolid {
    Bounds protrusion;         // the largest distance of a point of the union from the solid, proven
    Index protruding = kNone;  // the ball that sticks out farthest
    UnionVolume volume;
    MeanDistances mean;
    CuroboFigures curobo;
  };
  std::optional<BesideSolid> beside_solid;

  // Spheres that meet without overlapping leave open what cannot be told from nothing: the gap is no wider than
  // tolerance::kTangent of this length.
  bool only_tangent(double bounding_radius) const;
};

// How far a point is from the union of balls; below 0 in it: then the largest depth in a single ball. Infinity without
// any ball. O(n).
double gap_from(std::span<const Sphere> balls, const Point& point);

// Measures any set of balls against a surface; nothing is known of where the balls come from. The surface's cover is
// decided by the boundary lemma on each triangle; open area and largest gap by halving triangles until the lemma or a
// distance settles them; the protrusion by a branch and bound over each ball; volumes by rays; means by samples.
// Deterministic. A set of 60 balls beside 2,000 triangles takes about a second, one of 2,000 balls some ten times that.
// Throws InputError if there is no ball, or one whose radius is not positive and finite or whose centre is not finite.
SphereAudit audit_spheres(const Surface& surface, std::span<const Sphere> balls, const SphereAuditOptions& options = {},
                          const Progress& progress = {});

}  // namespace orchard
