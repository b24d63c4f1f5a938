#pragma once
#include <vector>

#include "cell_errors.h"
#include "sheet_mesh.h"

namespace orchard::detail {

// Mesh units.
struct LengthLimits {
  double least = 0, most = 0;
  double tolerance = 0;  // by how much interpolated balls may be off
};

// Returns the target length of the edges at each vertex. It is the largest length, but shorter where an edge of that
// length would be off by more than 0.4 of the tolerance, and at borders at most the radius of the balls. From a vertex
// to the next, it grows by at most a quarter of their distance. O(n log n).
std::vector<double> target_lengths(const SheetMesh& mesh, const CellErrors& errors, const LengthLimits& limits);

}  // namespace orchard::detail
