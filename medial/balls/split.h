#pragma once
#include <array>
#include <vector>

#include "ball_complex.h"
#include "orchard/geometry/progress.h"

namespace orchard::detail {

// The proven bound on how far balls protrude, as a multiple of the tolerance. It is not 1, because balls between the
// places that are checked may be off by another tolerance.
inline constexpr double kMaxStickingOut = 2;

struct SplitOptions {
  double tolerance = 0, merging = 0;  // mesh units; see RefineOptions and BallSolver
  double min_length = 0;              // mesh units: shorter edges are not divided
  int max_rounds = 0;
};

struct SplitReport {
  Index divided = 0, undivided = 0;
};

// The errors of cells that have been checked, so that no cell is checked twice. Cells are sorted. The error is negative
// for a cell that an earlier call gave up.
template <class Cell>
struct CachedCellErrors {
  std::vector<Cell> cells;
  std::vector<double> errors;
};

// The known errors of a complex, for the next call. They are valid as long as vertices keep their numbers and balls.
struct SplitErrors {
  // Adapts the cells to new numbers of the vertices, in the same order. Cells with a vertex that has no number (kNone)
  // are dropped.
  void renumber(const std::vector<Index>& number);

  CachedCellErrors<std::array<Index, 2>> edges;
  CachedCellErrors<std::array<Index, 3>> triangles;
};

// Divides edges until two conditions hold for the balls that are interpolated on edges and triangles:
// - At the places that are checked, balls protrude or fall short by at most the tolerance. These places are the
// quarters of
//   edges and the middles of triangles; on long cells, they are at most ten tolerances apart, and less where the solid
//   is thin.
// - It is proven that balls protrude by at most kMaxStickingOut tolerances.
// The error of a triangle counts for its longest edge. Edges through the interior surface of a mesh that cuts itself
// are not divided, because no division makes them linear. Cells that `known` lists as given up are left as they are.
// New vertices are exact where that is possible. The result is deterministic; the work is parallel.
SplitReport split_nonlinear(const Surface& surface, BallComplex& complex, const SplitOptions& options,
                            SplitErrors& known, const Progress& progress);

// Returns whether a triangle by itself can be divided in this way until no error exceeds the tolerance. Then all its
// balls belong to one sheet.
bool becomes_linear(const Surface& surface, const ExactBall& a, const ExactBall& b, const ExactBall& c,
                    const SplitOptions& options);

}  // namespace orchard::detail
