#pragma once
#include <functional>
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A point at `fraction` of the way along edge `edge` of a triangle.
struct EdgePoint {
  Index triangle;
  int edge;
  double fraction;
};

struct EdgePlacement {
  std::vector<EdgePoint> points;
  double length = 0;  // of all the edges that may get points
};

// Spreads at most `count` points over the edges whose two triangles divided(a, b) says are parted, and over those
// without just two triangles. Edges that meet two by two form chains; a table of partial sums of the chains' lengths
// decides the share of each chain, and a chain's n points lie at (k + 1/2) / n of its length, so that the gap at a
// chain's end is half a spacing. No closer than `min_spacing` on average.
EdgePlacement place_edge_points(const Surface& surface, const std::function<bool(Index, Index)>& divided, Index count,
                                double min_spacing);

}  // namespace orchard::detail
