#pragma once
#include <span>
#include <vector>

#include "orchard/covering/boundary_lemma.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"

// Checks whether every point of a surface lies in all balls of a path of a tree of balls.
namespace orchard {

// A triangle that is not certified to be covered.
struct UncoveredTriangle {
  Index triangle = kNone;
  TriangleCover cover;
};

// The result of surface_coverage().
struct Coverage {
  std::vector<UncoveredTriangle> uncovered;  // Ascending by triangle.
  bool complete() const { return uncovered.empty(); }
};

// Checks the path rule: every point of the surface lies in all balls of at least one path from a root to a leaf.
// Returns the triangles for which this is not certified. Centres of balls, witnesses and arcs are relative to `origin`,
// so that a model far from zero keeps its accuracy. UncoveredArc::ball is an index into `balls`. The work is parallel;
// the result does not depend on the number of threads.
Coverage surface_coverage(const Surface& surface, std::span<const PathBall> balls, const Point& origin = Point::Zero(),
                          const Progress& progress = {});

// Checks only the given triangles (ascending), for example those that a change affects.
Coverage surface_coverage(const Surface& surface, std::span<const Index> triangles, std::span<const PathBall> balls);

}  // namespace orchard
