#pragma once
#include <functional>
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// The point at `fraction` of the way along edge `edge` of a triangle.
struct EdgePoint {
  Index triangle;
  int edge;
  double fraction;
};

struct EdgePlacement {
  std::vector<EdgePoint> points;
  double length = 0;  // total length of the edges that may get points
};

// Spreads at most `count` points over the edges for whose two triangles divided(a, b) is true, and over edges that do
// not have two triangles. Such edges form chains through vertices where just two of them meet. A table of partial sums
// of the chains' lengths decides the number of points of each chain. The n points of a chain lie at (k + 1/2) / n of
// its length, so that the gap at its end is half a spacing. On average, points are not closer than `min_spacing`.
EdgePlacement place_edge_points(const Surface& surface, const std::function<bool(Index, Index)>& divided, Index count,
                                double min_spacing);

}  // namespace orchard::detail
