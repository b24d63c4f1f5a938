#pragma once
#include <vector>

#include "cell_components.h"

namespace orchard::detail {

struct NeckFault {
  bool found = false;
  std::vector<Index> neighbors;  // cells whose shared face is at fault, ascending
};

// Tests whether a cell's part of the surface breaks the rules under which the sampling keeps the surface's topology:
// each component is a disk, has at least three neighbours, and meets each of them along a single arc. If all cells keep
// them, any three cells meet in at most one point, and the dual of the net of cells has the surface's topology
// (Edelsbrunner and Shah 1997): no part of the solid is lost because it is thinner than the spacing of its samples.
// Precondition: `component` holds its cell's point. Faults with a neighbour of lower index are found in the test of
// that neighbour.
NeckFault find_neck(const Surface& surface, const RestrictedVoronoi& restricted, const CellComponent& component);

// Of the component's corners on its border with `neighbor` (or of all its corners, if that is kNone), the one that is
// farthest from the cell's point; and its triangle. Precondition: there is one.
std::pair<Point, Index> farthest_corner(const RestrictedVoronoi& restricted, const CellComponent& component,
                                        Index neighbor);

}  // namespace orchard::detail
