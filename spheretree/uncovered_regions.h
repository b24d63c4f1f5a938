#pragma once
#include <span>
#include <vector>

#include "orchard/covering/coverage.h"

// Finds the parts of a surface that a tree leaves uncovered, for all functions that close them. "Uncovered region"
// always means such a part; a "path region" is the common part of the balls on a path.
namespace orchard::detail {

// By how much every ball of a level grows after the level has been closed, as a fraction of R. Uncovered regions that
// this growth closes need no other work, and it makes sure that the levels below find their samples well inside some
// path region.
inline constexpr double kLastGrowth = 2e-5;

// A connected part of a triangle that no path region certainly contains.
struct UncoveredRegion {
  std::vector<Point> corners;  // on its border: the ends and middles of uncovered arcs
  Point farthest;              // the farthest of the points that were tried
  double distance = 0;         // how far it is outside; if this is 0 or less, only rounding errors are missing

  std::vector<Point> points() const;  // corners and farthest
};

// Returns the uncovered regions of all triangles. Arcs whose ends are within `near` of each other bound the same
// region. An arc bulges into its uncovered region, which therefore lies in the convex hull of its corners and of the
// corners of the triangle that are in it.
std::vector<UncoveredRegion> find_uncovered_regions(const Surface& surface, const Coverage& coverage,
                                                    std::span<const PathBall> balls, double near);

// The same without the regions that the last growth closes.
std::vector<UncoveredRegion> find_deep_uncovered_regions(const Surface& surface, const Coverage& coverage,
                                                         std::span<const PathBall> balls);

// Returns the triangles that may be uncovered, ascending. Most of those that a single path certainly contains are left
// out.
std::vector<Index> triangles_to_check(const Surface& surface, std::span<const PathBall> balls);

// The same after a change: of the triangles that were uncovered before it, and of those near the balls as they were
// before the change.
std::vector<Index> triangles_to_recheck(const Surface& surface, const Coverage& before, std::span<const Sphere> changed,
                                        std::span<const PathBall> balls);

}  // namespace orchard::detail
