#pragma once
#include <vector>

#include "orchard/geometry/sampling.h"
#include "restricted_voronoi.h"

namespace orchard::detail {

// A connected part of the surface inside one Voronoi cell.
struct CellPatch {
  Index cell = kNone;            // a point
  std::vector<Index> triangles;  // that it lies on, ascending
  bool home = false;             // holds the cell's point
  int euler_characteristic = 0;  // 1 for a disk
};

// The patches of all cells, ascending by cell, then by first triangle. A cell whose point forms no vertex has none.
// Every patch but the home patch is a crossing: there the cell reaches a part of the surface that its point does not
// lie on, and that nothing inside the cell joins to it.
std::vector<CellPatch> find_cell_patches(const Surface& surface, const SurfaceSampling& sampling,
                                         const RestrictedVoronoi& restricted);

}  // namespace orchard::detail
