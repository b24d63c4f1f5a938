#include <algorithm>
#include <vector>

#include "edge_gaps.h"
#include "extend_sheets.h"
#include "sharp_ends.h"

namespace orchard::detail {
namespace {

constexpr double kAtCorner = 1e-9;  // bounding radii: how far rounding moves a place off a corner

}  // namespace

Index divide_at_corners(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  SharpEdges edges(surface, *options.features);
  std::vector<Index> cut(complex.edges.size(), kNone);
  Index divided = 0;
  for (const auto& [corner, edge] : edges_around_corners(surface, complex, *options.features)) {
    const Point& place = surface.mesh().vertices[corner];
    ClosestPoint end = ExactBall::nowhere();
    if (cut[edge] != kNone || !edges.nearest_end(place, kAtCorner * surface.bounding_radius(), end)) continue;
    cut[edge] = complex.size();
    complex.balls.push_back(ball_on_edge(end));
    ++divided;
  }
  if (divided > 0) subdivide(complex, cut);
  return divided;
}

}  // namespace orchard::detail
