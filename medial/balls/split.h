#pragma once
#include <array>
#include <vector>

#include "ball_complex.h"
#include "orchard/geometry/progress.h"

namespace orchard::detail {

// Tolerances: balls between the places that dividing looks at may be off by the tolerance once more. So much do balls
// stick out of the solid at most, which is proven of each cell.
inline constexpr double kMaxStickingOut = 2;

struct SplitOptions {
  double tolerance = 0, merging = 0;  // mesh units; see RefineOptions and BallSolver
  double min_length = 0;              // mesh units: shorter edges are not divided
  int max_rounds = 0;
};

struct SplitReport {
  Index divided = 0, undivided = 0;
};

// The errors of sorted cells, so that no cell is looked at twice; negative ones of what earlier calls gave up.
template <class Cell>
struct CachedCellErrors {
  std::vector<Cell> cells;
  std::vector<double> errors;
};

// What dividing a complex found out, for the next time: as long as its vertices keep their numbers and balls.
struct SplitErrors {
  // For vertices that have other numbers now, in the same order, or none (kNone): cells with such are forgotten.
  void renumber(const std::vector<Index>& number);

  CachedCellErrors<std::array<Index, 2>> edges;
  CachedCellErrors<std::array<Index, 3>> triangles;
};

// Divides edges until the balls that are interpolated on edges and triangles neither protrude nor fall short by more
// than the tolerance: they are looked at at the quarters of edges and the middles of triangles, and every ten
// tolerances of long ones, or closer where they are thin; and until it is proven that they protrude by no more than
// kMaxStickingOut tolerances. A triangle's error counts for its longest edge. Edges
// through a wall of a surface that cuts itself are not divided: no division makes them linear. New vertices
// are exact where that is possible; what `known` has as left by an earlier call is left again. Deterministic; parallel.
SplitReport split_nonlinear(const Surface& surface, BallComplex& complex, const SplitOptions& options,
                            SplitErrors& known, const Progress& progress);

// Whether a triangle alone, divided like that, has no error beyond the tolerance left: its balls are all of one sheet.
bool becomes_linear(const Surface& surface, const ExactBall& a, const ExactBall& b, const ExactBall& c,
                    const SplitOptions& options);

}  // namespace orchard::detail
