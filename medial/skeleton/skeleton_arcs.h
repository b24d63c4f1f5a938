#pragma once
#include <cstdint>
#include <vector>

#include "orchard/medial/curve_skeleton.h"

namespace orchard::detail {

// Finds the nodes and arcs of a skeleton that has vertices, radii, edges and sheets. `significance` and `bare` (1 for
// a curve of the axis) have a value for each edge. O(n log n).
void trace_arcs(const std::vector<double>& significance, const std::vector<std::uint8_t>& bare,
                CurveSkeleton& skeleton);

}  // namespace orchard::detail
