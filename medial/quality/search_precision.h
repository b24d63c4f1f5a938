#pragma once
#include "orchard/geometry/mesh.h"

// When the branch-and-bound searches for a largest distance end, and what rounding does to their bounds.

namespace orchard::detail {

// Values that exceed what was found by less than this part of it are not searched for.
inline constexpr double kShareAbove = 0.02;

// More than what places, distances and bounds of a search in the box are off by.
inline double search_rounding(const Box& box) { return 1e-12 * (box.min().norm() + box.max().norm()); }

}  // namespace orchard::detail
