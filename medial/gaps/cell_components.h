#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "restricted_voronoi.h"

namespace orchard::detail {

// A connected part of the surface inside one Voronoi cell.
struct CellComponent {
  Index cell = kNone;            // the point of the Voronoi cell
  std::vector<Index> triangles;  // the triangles that the component lies on, ascending
  bool home = false;             // whether the component contains the cell's point
  int euler_characteristic = 0;  // 1 for a disk
};

// The cells to examine, and the triangles that contain all of their pieces.
struct ComponentScope {
  std::vector<std::uint8_t> cells;
  std::vector<Index> triangles;

  static ComponentScope everything(const Surface& surface, const SurfaceSampling& sampling);
};

// Returns the components of the cells in scope, ascending by cell, then by first triangle. Every component other than
// the home component is a crossing: the cell reaches a part of the surface that its point does not lie on, and that is
// not connected to the point inside the cell. A cell whose point forms no vertex has no component. Parallel.
std::vector<CellComponent> find_cell_components(const Surface& surface, const SurfaceSampling& sampling,
                                                const RestrictedVoronoi& restricted, const ComponentScope& scope);

}  // namespace orchard::detail
