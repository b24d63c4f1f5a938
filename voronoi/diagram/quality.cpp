#include "orchard/voronoi/quality.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "diagram/nearest_point.h"

namespace orchard {
namespace {

constexpr double kFarCorner = 10;  // in diagonals of the box
constexpr Index kBlock = 1024;     // vertices whose values are added up together
constexpr Index kReports = 64;     // the number of reports of progress

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

// Finds the nearest points to samples around one corner. No point is nearer than those within the ball through the
// farthest forming point, because that ball contains the balls around the samples through the points of their cells.
class Nearby {
 public:
  explicit Nearby(const detail::NearestPoint& all) : all_(all) {}

  // Call this before the other functions.
  void look_around(const VoronoiDiagram& diagram, const VoronoiVertex& vertex) {
    double squared = 0, max_coordinate = vertex.center.cwiseAbs().maxCoeff();
    for (const Index p : vertex.forming_points) {
      squared = std::max(squared, (diagram.points[p] - vertex.center).squaredNorm());
      max_coordinate = std::max(max_coordinate, diagram.points[p].cwiseAbs().maxCoeff());
    }
    const double reach = (1 + kWider) * std::sqrt(squared) + kWider * kWider * max_coordinate;
    knows_all_ = all_.within(vertex.center, reach * reach, kMany, found_);
  }

  // Returns the squared distance from q to the nearest point, or the limit if no point is nearer than that.
  double squared_distance(const Point& q, double limit) const {
    if (!knows_all_) return all_.squared_distance(q, limit);
    for (const Point& p : found_) limit = std::min(limit, (p - q).squaredNorm());
    return limit;
  }

 private:
  // Much larger than the rounding errors of the samples' positions relative to the ball; its square is much larger than
  // those of the coordinates.
  static constexpr double kWider = 0x1p-24;
  static constexpr std::size_t kMany = 32;  // up to this number of points, testing them all is cheaper than the tree

  const detail::NearestPoint& all_;
  bool knows_all_ = false;
  std::vector<Point> found_;
};

// Returns how much nearer than the cell's point the nearest point is to a sample on the segment from that point to a
// corner.
double excess(const Nearby& nearby, const Point& point, const Point& corner, double fraction) {
  const Point sample = point + fraction * (corner - point);
  const double own = (sample - point).squaredNorm();
  const double best = nearby.squared_distance(sample, own);
  return best < own ? std::sqrt(own) - std::sqrt(best) : 0;
}

// Adds the samples on the segment from one forming point of a vertex to the vertex.
void sample_segment(const VoronoiDiagram& diagram, const Nearby& nearby, const VoronoiVertex& vertex, unsigned slot,
                    Sum& sum) {
  double e = 1;
  // The balls around the samples through the cell's point are nested, so if the last one is empty, all are.
  for (const double fraction : {0.75, 0.5, 0.25}) {
    if (e > 0) e = excess(nearby, diagram.points[vertex.forming_points[slot]], vertex.center, fraction);
    sum.add_sample(e);
  }
}

void sample_corner(const VoronoiDiagram& diagram, const Nearby& nearby, const VoronoiVertex& vertex, Sum& sum) {
  std::array<double, 4> own;
  for (std::size_t i = 0; i < 4; ++i) own[i] = (diagram.points[vertex.forming_points[i]] - vertex.center).squaredNorm();
  const double best = nearby.squared_distance(vertex.center, *std::max_element(own.begin(), own.end()));
  for (const double squared : own) sum.add_sample(std::sqrt(squared) - std::sqrt(std::min(best, squared)));
}

// Decides which vertices count as corners.
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

// Calls visit(vertex index, block, Nearby) for every vertex that counts, in parallel over blocks.
template <class Visit>
void for_corners(const VoronoiDiagram& diagram, const Progress& progress, Visit&& visit) {
  const Scope scope(diagram);
  const detail::NearestPoint nearest(diagram.points);
  const auto count = static_cast<Index>(diagram.vertices.size());
  const Index blocks = block_count(diagram), step = blocks / kReports + 1;
  for (Index begin = 0; begin < blocks; begin += step) {
    report_progress(progress, "inaccuracy", static_cast<double>(begin) / blocks);
    tbb::parallel_for(tbb::blocked_range<Index>(begin, std::min(begin + step, blocks), 1), [&](const auto& range) {
      Nearby nearby(nearest);
      for (Index block = range.begin(); block < range.end(); ++block)
        for (Index v = block * kBlock; v < std::min(count, (block + 1) * kBlock); ++v)
          if (scope.contains(diagram.vertices[v])) visit(v, block, nearby);
    });
  }
  report_progress(progress, "inaccuracy", 1);
}

VoronoiInaccuracy mean_of(const std::vector<Sum>& blocks) {
  Sum sum;
  for (const Sum& block : blocks) sum.add(block);
  return {sum.samples == 0 ? 0 : sum.total / static_cast<double>(sum.samples), sum.max, sum.samples};
}

}  // namespace

VoronoiInaccuracies inaccuracies(const VoronoiDiagram& diagram, const Progress& progress) {
  if (diagram.vertices.empty()) return {};
  std::vector<Sum> segments(block_count(diagram)), corners(block_count(diagram));
  for_corners(diagram, progress, [&](Index v, Index block, Nearby& nearby) {
    const VoronoiVertex& vertex = diagram.vertices[v];
    if (!vertex.center.allFinite()) {
      segments[block].add_sample(std::numeric_limits<double>::infinity());
      corners[block].add_sample(std::numeric_limits<double>::infinity());
      return;
    }
    nearby.look_around(diagram, vertex);
    for (unsigned slot = 0; slot < 4; ++slot) sample_segment(diagram, nearby, vertex, slot, segments[block]);
    sample_corner(diagram, nearby, vertex, corners[block]);
  });
  return {mean_of(segments), mean_of(corners)};
}

VoronoiInaccuracy inaccuracy(const VoronoiDiagram& diagram) { return inaccuracies(diagram).segments; }

VoronoiInaccuracy corner_inaccuracy(const VoronoiDiagram& diagram) { return inaccuracies(diagram).corners; }

std::vector<double> cell_inaccuracies(const VoronoiDiagram& diagram) {
  std::vector<std::array<Sum, 4>> segments(diagram.vertices.size());
  for_corners(diagram, {}, [&](Index v, Index, Nearby& nearby) {
    nearby.look_around(diagram, diagram.vertices[v]);
    for (unsigned slot = 0; slot < 4; ++slot)
      sample_segment(diagram, nearby, diagram.vertices[v], slot, segments[v][slot]);
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
