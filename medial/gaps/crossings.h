#pragma once
#include <vector>

#include "cell_components.h"
#include "orchard/medial/gap_crossing.h"

namespace orchard::detail {

// A part of the surface that a Voronoi cell should not reach, or should not contain as a whole.
struct Crossing {
  CellComponent component;
  std::vector<Index> neighbors;  // the cells whose common face with component.cell has to be cut off, ascending
  bool neck = false;             // the component contains its cell's point but is not a disk among disks (neck_test.h)
  bool at_cut = false;  // two parts of the surface cut each other inside the cell, so no point can separate them
};

// Finds the faults of the cells in scope, ascending by cell: gap crossings by the given definition, and necks if they
// are to be repaired. Parallel.
std::vector<Crossing> find_crossings(const Surface& surface, const SurfaceSampling& sampling,
                                     const RestrictedVoronoi& restricted, const ComponentScope& scope,
                                     const GapRepairOptions& options);

// Returns the number of faces to cut off, each counted once, and the number of cells.
Index count_faces(const std::vector<Crossing>& crossings);
Index count_cells(const std::vector<Crossing>& crossings);

}  // namespace orchard::detail
