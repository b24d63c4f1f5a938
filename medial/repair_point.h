#pragma once
#include "cell_patches.h"

namespace orchard::detail {

// A point of the surface proposed for addition, so that cell `cell` no longer reaches a patch.
struct RepairPoint {
  Index cell = kNone;
  Point position = Point::Zero();
  Index triangle = kNone;
  Feature feature = Feature::face;
  bool snapped = false;  // no projection lies on the surface
  double gap = 0;        // from the cell's point to this one
};

enum class Across : std::uint8_t { normal, straight };

// Where the point of patch.cell should be repeated on the sheet of surface that holds `patch` (dissertation 6.2.4).
// Across::normal: its normal projection onto the cluster met first, if that lies within the cluster; on a curved sheet,
// where clusters are single triangles, the point of the sheet that is nearest by a walk from the patch.
// Across::straight: its mirror image in the bisector of its own tangent plane and the cluster's, which ends a bounce
// between the sides of a V. Failing that, the patch's point nearest to the cell's point: no free-floating point is ever
// proposed, and the cell owns this one, so that no other sample is near.
RepairPoint propose_repair(const Surface& surface, const SurfaceSampling& sampling, const RestrictedVoronoi& restricted,
                           const CellPatch& patch, const CellPatch* home, Across across);

}  // namespace orchard::detail
