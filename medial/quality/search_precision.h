#pragma once
#include "orchard/geometry/mesh.h"

// When the branch-and-bound searches for a largest distance stop, and how large the rounding errors of their bounds
// are.

namespace orchard::detail {

// As a fraction of the best value: the search ends when no value can exceed the best one by more.
inline constexpr double kShareAbove = 0.02;

// Returns more than the rounding error of places, distances and bounds of a search in the box.
inline double search_rounding(const Box& box) { return 1e-12 * (box.min().norm() + box.max().norm()); }

}  // namespace orchard::detail
