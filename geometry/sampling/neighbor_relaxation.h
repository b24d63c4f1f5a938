#pragma once
#include <vector>

#include "orchard/geometry/progress.h"
#include "surface_walk.h"

namespace orchard::detail {

// Points that repel others but do not move.
struct FixedPoints {
  std::vector<Point> positions;
  std::vector<Vector> normals;  // unit normals of the surface at the points
};

// Spreads points evenly on any surface by Turk's rule (1991), which uses no clusters. A neighbour on an adjacent
// triangle is turned about the shared edge into the plane of the point, and any other is projected onto it at the same
// distance. Points whose part of the surface faces away do not act. Steps are continued across edges by unfolding.
// Where the surface ends, its edge pushes as evenly spread points beyond it would. O(n) per iteration.
void relax_by_neighbors(const Surface& surface, const FixedPoints& fixed, int iterations,
                        std::vector<SurfacePoint>& points, const Progress& progress);

}  // namespace orchard::detail
