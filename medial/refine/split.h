#pragma once
#include "ball_complex.h"
#include "orchard/geometry/progress.h"

namespace orchard::detail {

struct SplitOptions {
  double tolerance = 0, merging = 0;  // mesh units; see RefineOptions and BallSolver
  double min_length = 0;              // mesh units: shorter edges are not divided
  int max_rounds = 0;
};

struct SplitReport {
  Index divided = 0, undivided = 0;
};

// Divides edges until the balls that are interpolated on edges and triangles neither protrude nor fall short by more
// than the tolerance: they are looked at at the quarters of edges and the middles of triangles, and every ten
// tolerances of long ones. A triangle's error counts for its longest edge. New vertices are exact where that is
// possible. Deterministic; parallel.
SplitReport split_nonlinear(const Surface& surface, BallComplex& complex, const SplitOptions& options,
                            const Progress& progress);

}  // namespace orchard::detail
