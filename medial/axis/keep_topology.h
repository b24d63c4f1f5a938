#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

struct KeptTopology {
  // For each Voronoi vertex that a stem (a single edge) joins to the axis, the neighbour that it is joined to; kNone
  // for vertices that are joined to all their neighbours. Empty if all are.
  std::vector<Index> stems;
  std::vector<std::array<Index, 2>> bridges;  // further edges, between pieces that no edge inside the solid joins
  Index left_out = 0;                         // vertices
};

// See AxisOptions::keep_topology. `inside` tells of each Voronoi vertex whether it is inside; it is set to 0 for
// vertices that are left out. The axis grows from one ball for each part of the surface. Adding a vertex, together with
// the edges and faces that it completes, keeps the homotopy type if these edges, two of them linked where they bound a
// completed face, form a tree: then the part of the axis that the vertex is glued to is contractible. When no further
// vertex can be added in this way, vertices next to the axis are joined by a stem: a single edge does not change the
// homotopy type either. Then a bridge along the shortest way through the outside leads to another piece, which grows in
// turn. So the sheets that would spoil the topology are left out, but not their balls. O(n log n) for each bridge.
KeptTopology keep_topology(const Surface& surface, const SurfaceSampling& sampling, const VoronoiDiagram& diagram,
                           const VoronoiFaces& faces, std::vector<std::uint8_t>& inside);

}  // namespace orchard::detail
