#pragma once
#include <vector>

#include "cell_components.h"

namespace orchard::detail {

struct NeckFault {
  bool found = false;
  std::vector<Index> neighbors;  // cells whose shared face is at fault, ascending
};

// Whether a cell's part of the surface, though in one piece, is no disk among disks. The cells' borders are a net of
// disks if every component is a disk, has three neighbours or more and meets each of them along a single arc; then
// three cells meet in one point at most, and the dual of the net has the surface's topology (Edelsbrunner and Shah
// 1997): no part of the solid thinner than the spacing of its samples is lost. `component` holds its cell's point;
// neighbours with a lower index are left to their own turn.
NeckFault find_neck(const Surface& surface, const RestrictedVoronoi& restricted, const CellComponent& component);

// The corner of the component that lies farthest from the cell's point, among those on its border with `neighbor`
// (anywhere, if kNone), and its triangle. Precondition: there is one.
std::pair<Point, Index> farthest_corner(const RestrictedVoronoi& restricted, const CellComponent& component,
                                        Index neighbor);

}  // namespace orchard::detail
