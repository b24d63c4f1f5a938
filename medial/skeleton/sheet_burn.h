#pragma once
#include <cstdint>
#include <vector>

#include "../axis/incidence.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// The rest of a complex after its sheets have burned from their borders, and the times of the fire.
struct SheetBurn {
  // The time at which each edge lost its last triangle; its mean radius for an edge that had none. It is NaN for an
  // edge that is gone or still has triangles.
  std::vector<double> isolated;
  std::vector<std::uint8_t> edge_alive, triangle_alive;
  // The time at which the fire has reached a vertex in all sheets around it; its radius for a vertex without sheets,
  // infinity on closed sheets.
  std::vector<double> vertex_times;
  // The mean direction of the fronts in the triangles around each vertex, by their area. Its length is about 1 where
  // one fire passes, and 0 where two meet head-on or there are no triangles.
  std::vector<Vector> vertex_fronts;
};

// Burns the triangles of a complete mesh. Every triangle disappears together with an edge that belongs to no other
// triangle any more, in an elementary collapse, so the rest has the homotopy type of the mesh. All vertices stay. If a
// triangle has several such edges, the one that burned first is taken, so that the rest runs along with the fire. The
// front is computed in the plane of each triangle, as a straight one between the times at the two ends of an edge.
// Where at least three sheets meet, the fire goes on into the last of them when the others have burned. O(n log n).
SheetBurn burn_sheets(const MedialMesh& mesh, const CellIncidence& at);

}  // namespace orchard::detail
