#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

// The result of keep_topology().
struct KeptTopology {
  // For each Voronoi vertex that a stem (a single edge) joins to the axis, the neighbour that it is joined to; kNone
  // for vertices that are joined to all their neighbours. Empty if nothing had to be changed.
  std::vector<Index> stems;
  std::vector<std::array<Index, 2>> bridges;  // further edges, between pieces that no edge inside the solid joins
  Index left_out = 0;                         // the number of vertices inside that are not in the axis
};

// Chooses the parts of the axis so that it has the topology of the solid: see AxisOptions::keep_topology. `inside` has
// a flag for each Voronoi vertex: whether it is inside. It is set to 0 for vertices that are left out. The axis grows
// in these steps:
//   1. It begins with one ball for each part of the surface.
//   2. Vertices are added, together with the edges and faces that they complete. That keeps the homotopy type if a
//      certain graph is a tree: its nodes are these edges, and two of them are linked if they bound a completed face.
//      Then the part of the axis that the vertex is glued to is contractible.
//   3. When no further vertex can be added in this way, the vertices next to the axis are joined by stems. A single
//      edge does not change the homotopy type either.
//   4. A bridge along the shortest path through the outside leads to another piece, which grows in the same way.
//
// So the sheets that would change the topology are left out, but not their balls. O(n log n) for each bridge.
KeptTopology keep_topology(const Surface& surface, const SurfaceSampling& sampling, const VoronoiDiagram& diagram,
                           const VoronoiFaces& faces, std::vector<std::uint8_t>& inside);

}  // namespace orchard::detail
