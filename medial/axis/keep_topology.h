#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

struct KeptTopology {
  // Of each Voronoi vertex: the one neighbour that it is joined to; kNone for those joined to all. Empty if all are.
  std::vector<Index> stems;
  std::vector<std::array<Index, 2>> bridges;  // further edges, between pieces that no edge inside joins
  Index left_out = 0;                         // vertices
};

// See AxisOptions::keep_topology. inside: of each Voronoi vertex whether it is inside; those left out become 0.
// Taking a vertex in, together with the edges and faces that it completes, leaves the homotopy type alone if the edges,
// joined where two of them bound a completed face, form a tree: then what the vertex is glued to is contractible. Grown
// from one ball for each part of the surface. Where that ends, an edge alone changes nothing either: vertices next to
// what is there are joined by a stem; then a bridge leads along the shortest way over the outside to another piece, and
// that grows in turn. No ball is lost with the sheets that spoil the topology. O(n log n) for each bridge.
KeptTopology keep_topology(const Surface& surface, const SurfaceSampling& sampling, const VoronoiDiagram& diagram,
                           const VoronoiFaces& faces, std::vector<std::uint8_t>& inside);

}  // namespace orchard::detail
