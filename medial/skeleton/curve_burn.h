#pragma once
#include <cstdint>
#include <vector>

#include "orchard/medial/curve_skeleton.h"
#include "sheet_burn.h"

namespace orchard::detail {

// The curves that remain of a burned complex after insignificant ones have been removed.
struct PrunedCurves {
  std::vector<std::uint8_t> edge_alive, vertex_alive;
  // Of each edge, the time between the fire of the sheets and that of the curves. It is infinite for edges that the
  // fire of the curves does not reach.
  std::vector<double> significance;
};

// Burns the curves of a complex from their ends, finds where each curve ends (SkeletonOptions), and removes what is
// beyond and the branches that are insignificant. `diagonal` is that of the solid, to which options.erosion refers, and
// `edge_length` the longest edge of the mesh; both in mesh units. A vertex disappears with its only edge, in an
// elementary collapse. O(n log n).
PrunedCurves prune_curves(const MedialMesh& mesh, const CellIncidence& at, const SheetBurn& burn,
                          const SkeletonOptions& options, double diagonal, double edge_length);

}  // namespace orchard::detail
