#pragma once
#include <cstdint>
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

// Which cells to look at, and the triangles that hold all their pieces.
struct PatchScope {
  std::vector<std::uint8_t> cells;
  std::vector<Index> triangles;

  static PatchScope everything(const Surface& surface, const SurfaceSampling& sampling);
};

// The patches of the cells in scope, ascending by cell, then by first triangle. Every patch but the home patch is a
// crossing: there the cell reaches a part of the surface that its point does not lie on, and that nothing inside the
// cell joins to it. A cell whose point forms no vertex has no patch. Parallel.
std::vector<CellPatch> find_cell_patches(const Surface& surface, const SurfaceSampling& sampling,
                                         const RestrictedVoronoi& restricted, const PatchScope& scope);

}  // namespace orchard::detail
