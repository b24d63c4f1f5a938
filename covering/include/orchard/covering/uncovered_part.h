#pragma once
#include <span>

#include "orchard/covering/inaccuracy.h"
#include "orchard/covering/path_forest.h"
#include "orchard/geometry/surface.h"

// Measures the part of a surface that the paths of a tree do not cover.
namespace orchard {

// The size of the uncovered part, and its distance from the paths.
struct UncoveredPart {
  Bounds area;  // The area of the points in no path region, in squared mesh units.
  // The area if each undecided cell counts as covered or not by its middle, in squared mesh units.
  double likely_area = 0;
  Bounds distance;                 // The largest path_distance() of a point, at least 0, in mesh units.
  Point farthest = Point::Zero();  // A point whose distance is distance.lower.
};

// The options of uncovered_part().
struct UncoveredPartOptions {
  double area_tolerance = 0.02;  // The largest upper - lower, as a fraction of the area itself.
  DistanceTolerance distance_tolerance;
  // The maximum number of cells of all triangles together. If it is reached, the bounds are wider.
  Index max_cells = 100'000;
};

// Halves the given triangles until the boundary lemma or the distance at the middle of a cell, which is 1-Lipschitz,
// decides whether the cell is covered. Other triangles count as covered. Triangles and balls are relative to `origin`.
UncoveredPart uncovered_part(const Surface& surface, std::span<const Index> triangles, const PathForest& forest,
                             const Point& origin = Point::Zero(), const UncoveredPartOptions& options = {});

}  // namespace orchard
