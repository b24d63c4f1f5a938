#pragma once
#include <span>
#include <vector>

#include "orchard/covering/boundary_lemma.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"

// Checks which triangles of a surface the paths of a tree of balls cover.
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
// Centres, witnesses and arcs are relative to `origin`, so that a model far from zero keeps its accuracy. Arcs refer to
// balls of the given array. The work is parallel over triangles; the result does not depend on the number of threads.
Coverage surface_coverage(const Surface& surface, std::span<const PathBall> balls, const Point& origin = Point::Zero(),
                          const Progress& progress = {});

// Checks the same for the given triangles (ascending) only, for example those that a change affects.
Coverage surface_coverage(const Surface& surface, std::span<const Index> triangles, std::span<const PathBall> balls);

}  // namespace orchard
