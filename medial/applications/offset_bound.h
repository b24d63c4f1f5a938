#pragma once
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Proven bounds on the distances from all places of a mesh to a surface, and places where they are nearly attained.
struct DistanceRange {
  double min = 0, max = 0;
  Point nearest = Point::Zero(), farthest = Point::Zero();
};

// Searches by branch and bound over the triangles of the mesh, until the bounds are within `accuracy` (mesh units) of
// values that are attained, or `max_parts` parts have been examined. The bounds on a part with middle c and radius r
// are these:
// - From above: the distance to one triangle of the surface is a convex function, so it is largest at a corner of the
//   part.
// - From below: that distance is at least its linearisation at c, |c - p| + g (x - c), where p is the place of the
//   triangle that is nearest to c, and g the unit vector from p to c. The smallest such value over all triangles that
//   come within the distance of c plus 2 r of c bounds the distance to the surface, because all others are farther
//   away.
// The bounds are rounded outward. Parallel; the result is the same for any number of threads.
DistanceRange distance_range(const TriangleMesh& mesh, const Surface& surface, double accuracy, std::size_t max_parts);

}  // namespace orchard::detail
