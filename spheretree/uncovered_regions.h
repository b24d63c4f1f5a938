#pragma once
#include <vector>

#include "orchard/covering/coverage.h"

namespace orchard::detail {

// A region of a triangle that no path region is certain to hold.
struct UncoveredRegion {
  std::vector<Point> corners;  // on its border: ends and middles of uncovered arcs
  Point deepest;               // of the points tried, the one farthest outside
  double depth = 0;            // how far; <= 0: nothing but rounding is missing
};

// The uncovered regions of all triangles. Arcs whose ends are within `near` of each other bound the same region. An arc
// bulges into its region, so the hull of a region's corners and of the triangle's own corners in it holds it.
std::vector<UncoveredRegion> find_uncovered_regions(const Surface& surface, const Coverage& coverage,
                                                    std::span<const PathBall> balls, double near);

}  // namespace orchard::detail
