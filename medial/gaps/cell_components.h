#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "restricted_voronoi.h"

namespace orchard::detail {

// A connected part of the surface inside one Voronoi cell.
struct CellComponent {
  Index cell = kNone;            // a point
  std::vector<Index> triangles;  // that it lies on, ascending
  bool home = false;             // holds the cell's point
  int euler_characteristic = 0;  // 1 for a disk
};

// Which cells to look at, and the triangles that hold all their pieces.
struct ComponentScope {
  std::vector<std::uint8_t> cells;
  std::vector<Index> triangles;

  static ComponentScope everything(const Surface& surface, const SurfaceSampling& sampling);
};

// The components of the cells in scope, ascending by cell, then by first triangle. Every component but the home
// component is a crossing: there the cell reaches a part of the surface that its point does not lie on, and that
// nothing inside the cell joins to it. A cell whose point forms no vertex has no component. Parallel.
std::vector<CellComponent> find_cell_components(const Surface& surface, const SurfaceSampling& sampling,
                                                const RestrictedVoronoi& restricted, const ComponentScope& scope);

}  // namespace orchard::detail
