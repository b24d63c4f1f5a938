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

Index block_count(const VoronoiDiagram& diagram) {
  return (static_cast<Index>(diagram.vertices.size()) + kBlock - 1) / kBlock;
}

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

// The samples on the way from one forming point of a vertex to it.
void sample_segment(const VoronoiDiagram& diagram, const detail::NearestPoint& nearest, const VoronoiVertex& vertex,
                    unsigned slot, Sum& sum) {
  double e = 1;
  // The balls around the samples through the cell's point lie within each other: if the last is empty, all are.
  for (const double fraction : {0.75, 0.5, 0.25}) {
    if (e > 0) e = excess(nearest, diagram.points[vertex.forming_points[slot]], vertex.center, fraction);
    sum.add_sample(e);
  }
}

void sample_segments(const VoronoiDiagram& diagram, const detail::NearestPoint& nearest, const VoronoiVertex& vertex,
                     Sum& sum) {
  for (unsigned slot = 0; slot < 4; ++slot) sample_segment(diagram, nearest, vertex, slot, sum);
}

void sample_corner(const VoronoiDiagram& diagram, const detail::NearestPoint& nearest, const VoronoiVertex& vertex,
                   Sum& sum) {
  std::array<double, 4> own;
  for (std::size_t i = 0; i < 4; ++i) own[i] = (diagram.points[vertex.forming_points[i]] - vertex.center).squaredNorm();
  const double best = nearest.squared_distance(vertex.center, *std::max_element(own.begin(), own.end()));
  for (const double squared : own) sum.add_sample(std::sqrt(squared) - std::sqrt(std::min(best, squared)));
}

// Which vertices count as corners.
class Scope {
 public:
  explicit Scope(const VoronoiDiagram& diagram) {
    for (const Point& p : diagram.points) box_.extend(p);
    limit_ = box_.isEmpty() ? 0 : kFarCorner * box_.diagonal().norm();
  }
  bool contains(const VoronoiVertex& vertex) const {
    return !vertex.at_infinity() && !(box_.exteriorDistance(vertex.center) > limit_);
  }

 private:
  Box box_;
  double limit_ = 0;
};

// visit(vertex index, block) for every vertex that counts, in parallel over blocks.
template <class Visit>
void for_corners(const VoronoiDiagram& diagram, Visit&& visit) {
  const Scope scope(diagram);
  const auto count = static_cast<Index>(diagram.vertices.size());
  tbb::parallel_for(tbb::blocked_range<Index>(0, block_count(diagram), 1), [&](const auto& range) {
    for (Index block = range.begin(); block < range.end(); ++block)
      for (Index v = block * kBlock; v < std::min(count, (block + 1) * kBlock); ++v)
        if (scope.contains(diagram.vertices[v])) visit(v, block);
  });
}

template <class Sample>
VoronoiInaccuracy over_vertices(const VoronoiDiagram& diagram, Sample&& sample) {
  if (diagram.vertices.empty()) return {};
  const detail::NearestPoint nearest(diagram.points);
  std::vector<Sum> blocks(block_count(diagram));
  for_corners(diagram, [&](Index v, Index block) {
    const VoronoiVertex& vertex = diagram.vertices[v];
    if (vertex.center.allFinite())
      sample(diagram, nearest, vertex, blocks[block]);
    else
      blocks[block].add_sample(std::numeric_limits<double>::infinity());
  });
  Sum sum;
  for (const Sum& block : blocks) sum.add(block);
  return {sum.samples == 0 ? 0 : sum.total / static_cast<double>(sum.samples), sum.max, sum.samples};
}

}  // namespace

VoronoiInaccuracy inaccuracy(const VoronoiDiagram& diagram) { return over_vertices(diagram, sample_segments); }

VoronoiInaccuracy corner_inaccuracy(const VoronoiDiagram& diagram) { return over_vertices(diagram, sample_corner); }

std::vector<double> cell_inaccuracies(const VoronoiDiagram& diagram) {
  const detail::NearestPoint nearest(diagram.points);
  std::vector<std::array<Sum, 4>> segments(diagram.vertices.size());
  for_corners(diagram, [&](Index v, Index) {
    for (unsigned slot = 0; slot < 4; ++slot)
      sample_segment(diagram, nearest, diagram.vertices[v], slot, segments[v][slot]);
  });
  std::vector<Sum> cells(diagram.points.size());
  for (Index v = 0; v < diagram.vertices.size(); ++v)
    for (unsigned slot = 0; slot < 4; ++slot)
      if (segments[v][slot].samples > 0) cells[diagram.vertices[v].forming_points[slot]].add(segments[v][slot]);
  std::vector<double> means;
  means.reserve(cells.size());
  for (const Sum& cell : cells) means.push_back(cell.samples == 0 ? 0 : cell.total / static_cast<double>(cell.samples));
  return means;
}

}  // namespace orchard
