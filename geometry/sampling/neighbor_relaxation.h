#pragma once
#include <vector>

#include "orchard/geometry/progress.h"
#include "surface_walk.h"

namespace orchard::detail {

// Points that repel others but stay where they are.
struct FixedPoints {
  std::vector<Point> positions;
  std::vector<Vector> normals;  // of the surface there, unit
};

// Evens out points on any surface by Turk's (1991) rule, which knows no clusters: a neighbour on an adjacent triangle
// is turned about the shared edge into the plane of the point, any other is projected on it, keeping its distance; what
// faces away is another sheet of the surface and does not count. Steps are unfolded across edges. Where the surface
// ends, its edge pushes like an even spread of points beyond it. O(n) per iteration.
void relax_by_neighbors(const Surface& surface, const FixedPoints& fixed, int iterations,
                        std::vector<SurfacePoint>& points, const Progress& progress);

}  // namespace orchard::detail
