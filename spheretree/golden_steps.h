#pragma once
#include <Eigen/Core>
#include <cmath>

#include "orchard/geometry/mesh.h"

// Additive low-discrepancy sequences in the unit square and the unit cube (Roberts 2018, "The unreasonable
// effectiveness of quasirandom sequences"). Their steps are powers of the inverse golden ratio of the dimension.

namespace orchard::detail {

inline double fraction(double x) { return x - std::floor(x); }

// Returns term n of the sequence that begins at `start`. The steps are powers of 1 / 1.3247.., where 1.3247.. is the
// root of x^3 = x + 1.
inline Eigen::Vector2d golden_place(const Eigen::Vector2d& start, double n) {
  return {fraction(start.x() + n * 0.7548776662466927), fraction(start.y() + n * 0.5698402909980532)};
}

// Returns term n of the sequence that begins at the middle of the cube. The steps are powers of 1 / 1.2207.., where
// 1.2207.. is the root of x^4 = x + 1.
inline Vector golden_place(double n) {
  return {fraction(0.5 + n * 0.8191725133961645), fraction(0.5 + n * 0.6710436067037893),
          fraction(0.5 + n * 0.5497004779019703)};
}

}  // namespace orchard::detail
