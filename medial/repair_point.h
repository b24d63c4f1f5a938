#pragma once
#include <optional>

#include "crossings.h"

namespace orchard::detail {

// How to look for the place across a gap that faces a point.
enum class Across : std::uint8_t {
  normal,    // normal projection onto the cluster that is met first
  straight,  // mirror image in the bisector of the point's tangent plane and the cluster's: it lies as deep in a V as
             // the point does, so that the new face is the bisector, and the two sides of a V do not bounce points for
             // ever
};

// Points of the surface that would take the patch away from the cell, the better one first. Distances are from the
// cell's point.
struct RepairProposal {
  std::optional<ClosestPoint> projected;  // the sheet of surface that holds the patch faces the cell's point here
  ClosestPoint snapped;                   // of the patch: nothing but the cell's point is near it
};

// Dissertation 6.2.4. A projection counts if it lies within the cluster; on a curved sheet, where clusters are single
// triangles, the point of the sheet nearest to the target is found by a walk from the patch over edges that are all but
// flat, and counts if the surface faces the cell's point there. So no free-floating point is ever proposed. The point
// to snap to is the patch's nearest, and for necks the farthest on the border that is at fault.
RepairProposal propose_repair(const Surface& surface, const SurfaceSampling& sampling,
                              const RestrictedVoronoi& restricted, const Crossing& crossing, Across across);

}  // namespace orchard::detail
