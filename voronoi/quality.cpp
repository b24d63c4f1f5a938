#include "orchard/voronoi/quality.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "nearest_point.h"

namespace orchard {
namespace {

constexpr double kFarCorner = 10;  // box diagonals
constexpr Index kBlock = 1024;     // vertices that one sum runs over

struct Sum {
  double total = 0, max = 0;
  std::uint64_t samples = 0;

  void add_sample(double excess) {
    total += excess;
    max = std::max(max, excess);
    ++samples;
  }
  void add(const Sum& other) {
    total += other.total;
    max = std::max(max, other.max);
    samples += other.samples;
  }
};

// How much nearer than the cell's point the nearest point is to a sample on the way from the point to a corner.
double excess(const detail::NearestPoint& nearest, const Point& point, const Point& corner, double fraction) {
  const Point sample = point + fraction * (corner - point);
  const double own = (sample - point).squaredNorm();
  const double best = nearest.squared_distance(sample, own);
  return best < own ? std::sqrt(own) - std::sqrt(best) : 0;
}

void sample_segments(const VoronoiDiagram& diagram, const detail::NearestPoint& nearest, const VoronoiVertex& vertex,
                     Sum& sum) {
  for (const Index p : vertex.forming_points) {
    double e = 1;
    // The balls around the samples through the cell's point lie within each other: if the last is empty, all are.
    for (const double fraction : {0.75, 0.5, 0.25}) {
      if (e > 0) e = excess(nearest, diagram.points[p], vertex.center, fraction);
      sum.add_sample(e);
    }
  }
}

void sample_corner(const VoronoiDiagram& diagram, const detail::NearestPoint& nearest, const VoronoiVertex& vertex,
                   Sum& sum) {
  std::array<double, 4> own;
  for (std::size_t i = 0; i < 4; ++i) own[i] = (diagram.points[vertex.forming_points[i]] - vertex.center).squaredNorm();
  const double best = nearest.squared_distance(vertex.center, *std::max_element(own.begin(), own.end()));
  for (const double squared : own) sum.add_sample(std::sqrt(squared) - std::sqrt(std::min(best, squared)));
}

template <class Sample>
VoronoiInaccuracy over_vertices(const VoronoiDiagram& diagram, Sample&& sample) {
  if (diagram.vertices.empty()) return {};
  Box box;
  for (const Point& p : diagram.points) box.extend(p);
  const double limit = kFarCorner * box.diagonal().norm();
  const detail::NearestPoint nearest(diagram.points);
  const auto count = static_cast<Index>(diagram.vertices.size());
  std::vector<Sum> blocks((count + kBlock - 1) / kBlock);
  const auto sum_block = [&](Index block) {
    for (Index v = block * kBlock; v < std::min(count, (block + 1) * kBlock); ++v) {
      const VoronoiVertex& vertex = diagram.vertices[v];
      if (vertex.at_infinity() || box.exteriorDistance(vertex.center) > limit) continue;
      if (vertex.center.allFinite())
        sample(diagram, nearest, vertex, blocks[block]);
      else
        blocks[block].add_sample(std::numeric_limits<double>::infinity());
    }
  };
  tbb::parallel_for(tbb::blocked_range<Index>(0, static_cast<Index>(blocks.size()), 1), [&](const auto& range) {
    for (Index block = range.begin(); block < range.end(); ++block) sum_block(block);
  });
  Sum sum;
  for (const Sum& block : blocks) sum.add(block);
  return {sum.samples == 0 ? 0 : sum.total / static_cast<double>(sum.samples), sum.max, sum.samples};
}

}  // namespace

VoronoiInaccuracy inaccuracy(const VoronoiDiagram& diagram) { return over_vertices(diagram, sample_segments); }

VoronoiInaccuracy corner_inaccuracy(const VoronoiDiagram& diagram) { return over_vertices(diagram, sample_corner); }

}  // namespace orchard
