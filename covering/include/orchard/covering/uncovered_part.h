#pragma once
#include <span>

#include "orchard/covering/inaccuracy.h"
#include "orchard/covering/path_forest.h"
#include "orchard/geometry/surface.h"

namespace orchard {

// How much of a surface has no path, and how far off the paths are.
struct UncoveredPart {
  Bounds area;                     // of the points that lie in no path region, in squared mesh units
  double likely_area = 0;          // the undecided cells counted by their middles
  Bounds distance;                 // largest path_distance() of a point, at least 0, in mesh units
  Point farthest = Point::Zero();  // a point at distance.lower
};

struct UncoveredPartOptions {
  double area_tolerance = 0.02;  // of the area itself: upper - lower
  DistanceTolerance distance_tolerance;
  Index max_cells = 100'000;  // of all triangles together; where they run out, the bounds are wider
};

// Halves the given triangles until the boundary lemma or the distance at a cell's middle, which is
// 1-Lipschitz, settles what is covered and what is not. Other triangles count as covered. Triangles are taken relative
// to `origin`, as the balls are.
UncoveredPart uncovered_part(const Surface& surface, std::span<const Index> triangles, const PathForest& forest,
                             const Point& origin = Point::Zero(), const UncoveredPartOptions& options = {});

}  // namespace orchard
