#pragma once
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Proven bounds on the distances from all places of a mesh to a surface, and places where they are nearly attained.
struct DistanceRange {
  double min = 0, max = 0;
  Point nearest = Point::Zero(), farthest = Point::Zero();
};

// By branch and bound over the triangles of the mesh, until the bounds are within `accuracy` (mesh units) of values
// that are attained, or `max_parts` parts were looked at. On a part with middle c and radius r:
// - from above, the distance to one triangle of the surface is convex, so largest at a corner of the part;
// - from below, it is at least its linearisation at c: |c - p| + g (x - c), with p the triangle's place nearest to c
//   and g the unit vector from p to c. The least of that over all triangles of the surface that come within the
//   distance of c plus 2 r of c bounds the distance to the surface, for all others are farther.
// Rounded outward. Parallel; the same for any number of threads.
DistanceRange distance_range(const TriangleMesh& mesh, const Surface& surface, double accuracy, std::size_t max_parts);

}  // namespace orchard::detail
