#pragma once
#include <span>

#include "workspace.h"

namespace orchard::detail {

// On the way around an edge of the hull, from the vertex at infinity on one side to that on the other.
struct HullPlace {
  Index at, from, behind;  // a vertex, the one before it, and the point that this one has instead of a shared one

  // At the first vertex after v, the neighbour of v being `slot`.
  static HullPlace first(const VoronoiVertex& vertex, Index v, unsigned slot) {
    return {vertex.neighbors[3], v, vertex.forming_points[slot]};
  }
};

// The edge of the hull between the facets of a vertex at infinity and of its neighbour `slot`.
struct HullEdge {
  Index v, u;
  unsigned slot;
  bool convex = false;
  HullPlace doubtful{};
};

// Notes which edges are convex beyond doubt: doubles show that the neighbour's third point is below the facet of v.
void note_convex(const Workspace& workspace, std::span<HullEdge> edges);

// Of edges that are not: notes around the edge, from the facet of v to that of its neighbour, where the first point is
// that is not below the facet of v beyond doubt.
void walk_to_doubt(const Workspace& workspace, std::span<HullEdge> edges);

}  // namespace orchard::detail
