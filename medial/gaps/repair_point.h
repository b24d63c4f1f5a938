#pragma once
#include <vector>

#include "crossings.h"

namespace orchard::detail {

// Points of the surface that would take the component away from the cell. Distances are from the cell's point.
struct RepairProposal {
  std::vector<ClosestPoint> facing;  // on the sheet of surface that holds the component; the better one first
  ClosestPoint snapped;              // of the component itself: nothing but the cell's point is near it

  double gap() const { return facing.empty() ? snapped.distance : facing[0].distance; }
};

// Dissertation 6.2.4. First straight across: the mirror image of the cell's point in the bisector of its own tangent
// plane and the plane of the cluster that it meets first. It lies as deep in a V as the point does, so that the new
// face is the bisector and crosses neither side; between parallel sides it is the normal projection. Then the normal
// projection itself. Either counts if it lies within the cluster; on a curved sheet, where clusters are single
// triangles, the point of the sheet nearest to the target is found by a walk from the component over edges that are all
// but flat, and counts if the surface faces the cell's point there. So no free-floating point is ever proposed. The
// point to snap to is the component's nearest, and for necks the farthest on the border that is at fault. bounced: the
// point is itself the last of several repair points; then the bottom of the V, if near, comes first.
RepairProposal propose_repair(const Surface& surface, const SurfaceSampling& sampling,
                              const RestrictedVoronoi& restricted, const Crossing& crossing, bool bounced);

}  // namespace orchard::detail
