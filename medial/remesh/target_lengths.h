#pragma once
#include <vector>

#include "cell_errors.h"
#include "sheet_mesh.h"

namespace orchard::detail {

// Mesh units.
struct LengthLimits {
  double least = 0, most = 0;
  double tolerance = 0;  // that interpolated balls may be off by
};

// For each vertex, how long edges at it should be: the most, but shorter where an edge of that length would be off by
// more than .4 of the tolerance, and on borders no longer than their balls are large; growing by no more than a quarter
// of the way from one vertex to the next. O(n log n).
std::vector<double> target_lengths(const SheetMesh& mesh, const CellErrors& errors, const LengthLimits& limits);

}  // namespace orchard::detail
