#include "orchard/voronoi/quality.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nearest_point.h"

namespace orchard {
namespace {

constexpr double kFarCorner = 10;  // box diagonals
constexpr Index kBlock = 1024;     // vertices that one sum runs over

struct Sum {
  double total = 0, max = 0, corner_total = 0, corner_max = 0;
  std::uint64_t samples = 0;

  void add(const Sum& other) {
    total += other.total;
    max = std::max(max, other.max);
    samples += other.samples;
    corner_total += other.corner_total;
    corner_max = std::max(corner_max, other.corner_max);
  }
};

// How much nearer than the cell's point the nearest point is to a sample on the way from the point to a corner.
double excess(const detail::NearestPoint& nearest, const Point& point, const Point& corner, double fraction) {
  const Point sample = point + fraction * (corner - point);
  const double own = (sample - point).squaredNorm();
  const double best = nearest.squared_distance(sample, own);
  return best < own ? std::sqrt(own) - std::sqrt(best) : 0;
}

Sum inaccuracy_of_corner(const detail::NearestPoint& nearest, const Point& point, const Point& corner) {
  Sum sum{.samples = 3};
  // The balls around the samples through the cell's point lie within each other: if the last is empty, all are.
  // The corner's own ball is the largest; but it has three more points on it, so round-off decides whether it is empty.
  sum.corner_total = sum.corner_max = excess(nearest, point, corner, 1);
  for (double fraction : {0.75, 0.5, 0.25}) {
    const double e = excess(nearest, point, corner, fraction);
    if (!(e > 0)) break;
    sum.total += e;
    sum.max = std::max(sum.max, e);
  }
  return sum;
}

Sum inaccuracy_of_vertices(const VoronoiDiagram& diagram, const detail::NearestPoint& nearest, const Box& box,
                           Index begin, Index end) {
  Sum sum;
  const double limit = kFarCorner * box.diagonal().norm();
  for (Index v = begin; v < end; ++v) {
    const VoronoiVertex& vertex = diagram.vertices[v];
    if (vertex.at_infinity()) continue;
    if (!vertex.center.allFinite()) {
      const double infinity = std::numeric_limits<double>::infinity();
      return {infinity, infinity, infinity, infinity, sum.samples + 1};
    }
    if (box.exteriorDistance(vertex.center) > limit) continue;
    for (Index p : vertex.forming_points) sum.add(inaccuracy_of_corner(nearest, diagram.points[p], vertex.center));
  }
  return sum;
}

}  // namespace

VoronoiInaccuracy inaccuracy(const VoronoiDiagram& diagram) {
  if (diagram.vertices.empty()) return {};
  Box box;
  for (const Point& p : diagram.points) box.extend(p);
  const detail::NearestPoint nearest(diagram.points);
  const auto count = static_cast<Index>(diagram.vertices.size());
  std::vector<Sum> blocks((count + kBlock - 1) / kBlock);
  tbb::parallel_for(tbb::blocked_range<Index>(0, static_cast<Index>(blocks.size()), 1), [&](const auto& range) {
    for (Index b = range.begin(); b < range.end(); ++b)
      blocks[b] = inaccuracy_of_vertices(diagram, nearest, box, b * kBlock, std::min(count, (b + 1) * kBlock));
  });
  Sum sum;
  for (const Sum& block : blocks) sum.add(block);
  if (sum.samples == 0) return {};
  const auto samples = static_cast<double>(sum.samples);
  return {sum.total / samples, sum.max, sum.samples, sum.corner_total / (samples / 3), sum.corner_max};
}

}  // namespace orchard
