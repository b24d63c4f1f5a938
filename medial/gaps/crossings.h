#pragma once
#include <vector>

#include "cell_components.h"
#include "orchard/medial/gap_crossing.h"

namespace orchard::detail {

// A part of the surface that a Voronoi cell should not reach, or should not hold as a whole.
struct Crossing {
  CellComponent component;
  std::vector<Index> neighbors;  // cells whose face shared with component.cell is at fault, ascending
  bool neck = false;             // the component holds its point but is no disk among disks (neck_test.h)
  bool at_cut = false;           // two parts of the surface cut each other inside the cell: no point keeps them apart
};

// What is wrong with the cells in scope, ascending by cell: gap crossings by the given definition, and necks if they
// are to be mended. Parallel.
std::vector<Crossing> find_crossings(const Surface& surface, const SurfaceSampling& sampling,
                                     const RestrictedVoronoi& restricted, const ComponentScope& scope,
                                     const GapRepairOptions& options);

// How many faces are at fault, each counted once; and how many cells.
Index count_faces(const std::vector<Crossing>& crossings);
Index count_cells(const std::vector<Crossing>& crossings);

}  // namespace orchard::detail
