#pragma once
#include <vector>

#include "orchard/medial/prune.h"

namespace orchard::detail {

// The measures that a cell has by itself: the angle in radians at which its two points are seen, and half their
// distance in mesh units. 0 removes nothing.
struct CellLimits {
  double angle = 0, lambda = 0;
};

// Removes cells of an axis as a whole, as prune() does with polygons: those below `limits`, and those with a corner v
// for which over_limit[v], the quotient of a measure and its limit, is below 1. The least quotients go first. O(n log
// n).
MedialAxis prune_cells(const MedialAxis& axis, const CellLimits& limits, const std::vector<double>& over_limit);

}  // namespace orchard::detail
