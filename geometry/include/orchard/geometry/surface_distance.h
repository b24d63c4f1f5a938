#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"

// The one-sided Hausdorff distance between two surfaces.
namespace orchard {

// Proven bounds on the largest distance from a point of one surface to another, in mesh units.
struct SurfaceDistance {
  double lower = 0, upper = 0;
  Point at = Point::Zero();  // A point of the first surface at the distance `lower` from the second one.
};

// The options of surface_distance().
struct SurfaceDistanceOptions {
  double tolerance = 1e-4;  // The largest upper - lower, in bounding radii of `to`.
  // The maximum number of closest-point queries. If it is reached, the bounds are wider.
  Index max_evaluations = 20000000;
};

// Computes the one-sided Hausdorff distance by branch and bound over the triangles of `from`. The distance to a surface
// is 1-Lipschitz, and the distance to one triangle is convex, so that it is largest at a corner of a piece. Takes about
// three closest-point queries for each triangle that lies flat on `to`. Source: the idea of Tang, Lee and Kim 2009.
SurfaceDistance surface_distance(const Surface& from, const Surface& to, const SurfaceDistanceOptions& options = {},
                                 const Progress& progress = {});

}  // namespace orchard
