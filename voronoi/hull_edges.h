#pragma once
#include <span>

#include "workspace.h"

namespace orchard::detail {

// The edge of the hull between the facets of a vertex at infinity and of its neighbour `slot`.
struct HullEdge {
  Index v, u;
  unsigned slot;
  bool convex = false;
};

// Notes which edges are convex beyond doubt: around the edge, from the facet of v to that of its neighbour, doubles
// show that all points are below the facet of v. The vertices, oriented positively, turn by less than 180 degrees then.
void note_convex(const Workspace& workspace, std::span<HullEdge> edges);

}  // namespace orchard::detail
