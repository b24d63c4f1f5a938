#pragma once
#include <vector>

#include "crossings.h"

namespace orchard::detail {

// Points of the surface which, as samples, would take the component away from the cell. Distances are from the cell's
// point.
struct RepairProposal {
  std::vector<ClosestPoint> facing;  // on the sheet that holds the component; the better first
  ClosestPoint snapped;              // on the component itself: near it there is no sample but the cell's

  double gap() const { return facing.empty() ? snapped.distance : facing[0].distance; }
};

// The repair points of dissertation 6.2.4. The first candidate lies straight across: it is the mirror image of the
// cell's point in the bisector of its own tangent plane and the plane of the cluster that it meets first. In a V it
// lies as deep as the point itself, so the new face is the bisector and crosses neither side; between parallel sides it
// is the normal projection. The second candidate is the normal projection itself. A candidate is accepted if it lies
// within the cluster. On a curved sheet, where clusters are single triangles, the point of the sheet nearest to the
// candidate is searched by a walk from the component over nearly flat edges, and accepted if the surface faces the
// cell's point there. So every proposed point lies on the surface. The point to snap to is the component's nearest; for
// necks it is the farthest on the border that is at fault. `bounced`: the cell's point is itself the last of several
// repair points; then the bottom of the V, if it is near, is proposed first.
RepairProposal propose_repair(const Surface& surface, const SurfaceSampling& sampling,
                              const RestrictedVoronoi& restricted, const Crossing& crossing, bool bounced);

}  // namespace orchard::detail
