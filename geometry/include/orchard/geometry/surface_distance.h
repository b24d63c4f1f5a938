#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"

namespace orchard {

// The largest distance from a point of one surface to another lies between the two bounds, always.
struct SurfaceDistance {
  double lower = 0, upper = 0;
  Point at = Point::Zero();  // a point of the first surface, `lower` away from the second
};

struct SurfaceDistanceOptions {
  double tolerance = 1e-4;           // upper - lower, in bounding radii of `to`
  Index max_evaluations = 20000000;  // closest-point queries; where they run out, the bounds are wider
};

// One-sided Hausdorff distance by branch and bound over the triangles of `from`: the distance to a surface is
// 1-Lipschitz, and the distance to one triangle is convex, so on a piece it is largest at a corner (the idea of Tang,
// Lee and Kim 2009). About three closest-point queries for each triangle that lies flat on `to`.
SurfaceDistance surface_distance(const Surface& from, const Surface& to, const SurfaceDistanceOptions& options = {},
                                 const Progress& progress = {});

}  // namespace orchard
