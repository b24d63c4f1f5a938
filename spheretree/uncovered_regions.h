#pragma once
#include <span>
#include <vector>

#include "orchard/covering/coverage.h"

// The parts of a surface that a tree leaves open, and what all that close them have in common. "Uncovered region"
// always means such a part; a "path region" is the common part of the balls on a path.
namespace orchard::detail {

// What every ball of a level grows by once the level is closed, as a fraction of R. Uncovered regions that such growth
// fills need no more work, and the levels below find their samples well inside some path region.
inline constexpr double kLastGrowth = 2e-5;

// A connected part of a triangle that no path region is certain to hold.
struct UncoveredRegion {
  std::vector<Point> corners;  // on its border: ends and middles of uncovered arcs
  Point farthest;              // of the points tried, the one farthest outside
  double distance = 0;         // how far; <= 0: nothing but rounding is missing

  std::vector<Point> points() const;  // corners and farthest
};

// The uncovered regions of all triangles. Arcs whose ends are within `near` of each other bound the same one. An arc
// bulges into its uncovered region, which therefore lies in the convex hull of its corners and of those corners of the
// triangle that are in it.
std::vector<UncoveredRegion> find_uncovered_regions(const Surface& surface, const Coverage& coverage,
                                                    std::span<const PathBall> balls, double near);

// The same, without those that the last growth fills.
std::vector<UncoveredRegion> find_deep_uncovered_regions(const Surface& surface, const Coverage& coverage,
                                                         std::span<const PathBall> balls);

// The triangles that may be uncovered, ascending: all but most of those that one path surely holds.
std::vector<Index> triangles_to_check(const Surface& surface, std::span<const PathBall> balls);

// The same after a change: of those that were uncovered before it, and of those near the balls as they were before they
// changed.
std::vector<Index> triangles_to_recheck(const Surface& surface, const Coverage& before, std::span<const Sphere> changed,
                                        std::span<const PathBall> balls);

}  // namespace orchard::detail
