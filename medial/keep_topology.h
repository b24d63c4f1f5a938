#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

// See AxisOptions::keep_topology. inside: of each Voronoi vertex whether it is inside; those left out become 0. Returns
// how many. Taking a vertex in, together with the edges and faces that it completes, leaves the homotopy type alone if
// the edges, joined where two of them bound a completed face, form a tree: then what the vertex is glued to is
// contractible. Grown from one ball for each part of the surface. O(n log n).
Index keep_topology(const Surface& surface, const SurfaceSampling& sampling, const VoronoiDiagram& diagram,
                    const VoronoiFaces& faces, std::vector<std::uint8_t>& inside);

}  // namespace orchard::detail
