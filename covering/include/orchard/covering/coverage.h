#pragma once
#include <span>
#include <vector>

#include "orchard/covering/boundary_lemma.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"

namespace orchard {

struct UncoveredTriangle {
  Index triangle = kNone;
  TriangleCover cover;
};

struct Coverage {
  std::vector<UncoveredTriangle> uncovered;  // ascending by triangle
  bool complete() const { return uncovered.empty(); }
};

// Checks the path rule: every point of the surface lies in all balls of at least one path from a root to a leaf.
// Centres, witnesses and arcs are relative to `origin`, so that a model far from zero keeps its accuracy; arcs name
// balls of the given array. Parallel over triangles; the result does not depend on the thread count.
Coverage surface_coverage(const Surface& surface, std::span<const PathBall> balls, const Point& origin = Point::Zero(),
                          const Progress& progress = {});

// The same for a subset of the triangles (ascending), for rechecking what a change touched.
Coverage surface_coverage(const Surface& surface, std::span<const Index> triangles, std::span<const PathBall> balls);

}  // namespace orchard
