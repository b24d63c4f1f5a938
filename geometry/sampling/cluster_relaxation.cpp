#include "cluster_relaxation.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "boundary_push.h"
#include "cell_hash.h"
#include "relaxation_constants.h"

namespace orchard::detail {
namespace {

using Point2 = Eigen::Vector2d;

// A squared distance that exceeds the range by more than this factor is certainly out of range, despite rounding.
constexpr double kSurely = 1 + 1e-9;

class ClusterRelaxation {
 public:
  ClusterRelaxation(const Surface& surface, const Clusters& clusters, Index cluster, std::vector<Index> members,
                    double line_density, const BoundaryPush& push)
      : surface_(surface),
        clusters_(clusters),
        cluster_(cluster),
        members_(std::move(members)),
        push_(push),
        line_density_(line_density) {
    double area = 0;
    Box box;
    for (const Index t : clusters.triangles[cluster]) {
      area += surface.area(t);
      for (const Point& p : surface.corners(t)) box.extend(p);
    }
    const auto count = static_cast<double>(members_.size());
    spacing_ = std::sqrt(area / count);
    // A strip that is narrower than the spacing contains a row of points rather than an area of them.
    radius_ = kRepulsionRadius * std::max(spacing_, box.diagonal().norm() / count);
    make_frame();
    collect_edges();
  }

  void iterate(std::vector<SurfacePoint>& points, double step_size) {
    positions_.resize(members_.size());
    cells_.resize(members_.size());
    const CellHash grid = sort_points(points);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, members_.size(), kRelaxationGrain), [&](const auto& range) {
      const SurfaceWalker walker(surface_);
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const Point2 step = bounded(step_size * spacing_ * force(i, grid));
        walker.walk(points[members_[i]], step.x() * u_ + step.y() * v_,
                    [&](Index, Index to) { return clusters_.of_triangle[to] == cluster_; });
      }
    });
  }

 private:
  struct Edge {
    Point2 start, along, inward;
    double length;
  };

  void make_frame() {
    const Index first = clusters_.triangles[cluster_][0];
    const auto p = surface_.corners(first);
    origin_ = p[0];
    u_ = (p[1] - p[0]).normalized();
    v_ = surface_.normal(first).cross(u_);
  }
  Point2 flat(const Point& p) const { return {u_.dot(p - origin_), v_.dot(p - origin_)}; }

  void collect_edges() {
    std::vector<Cell> cells;
    for (const Index t : clusters_.triangles[cluster_]) {
      const auto p = surface_.corners(t);
      for (std::size_t i = 0; i < 3; ++i) {
        const Index other = surface_.neighbors(t)[i];
        if (other != kNone && clusters_.of_triangle[other] == cluster_) continue;
        const Point2 a = flat(p[i]), b = flat(p[(i + 1) % 3]);
        const double length = (b - a).norm();
        if (!(length > 0)) continue;
        const Point2 along = (b - a) / length;
        edges_.push_back({a, along, {-along.y(), along.x()}, length});
        add_cells(a, b, cells);
      }
    }
    edge_grid_.build(cells);
  }

  // Adds the cells that come within the radius of the edge, row by row.
  void add_cells(const Point2& a, const Point2& b, std::vector<Cell>& cells) {
    const Point2 &low = a.y() < b.y() ? a : b, &high = a.y() < b.y() ? b : a;
    const auto first = static_cast<int>(std::floor(low.y() / radius_)) - 1;
    const auto last = static_cast<int>(std::floor(high.y() / radius_)) + 1;
    for (int row = first; row <= last; ++row) {
      const double rise = high.y() - low.y();
      const auto x_at = [&](double y) {
        const double t = rise > 0 ? std::clamp((y - low.y()) / rise, 0.0, 1.0) : 0.0;
        return low.x() + t * (high.x() - low.x());
      };
      double left = x_at((row - 1) * radius_), right = x_at((row + 2) * radius_);
      if (!(rise > 0)) left = low.x(), right = high.x();
      if (left > right) std::swap(left, right);
      for (auto column = static_cast<int>(std::floor(left / radius_)) - 1;
           column <= static_cast<int>(std::floor(right / radius_)) + 1; ++column) {
        cells.push_back({column, row, 0});
        edge_in_cell_.push_back(static_cast<Index>(edges_.size() - 1));
      }
    }
  }

  CellHash sort_points(const std::vector<SurfacePoint>& points) {
    CellHash grid(Point::Zero(), radius_);
    for (std::size_t i = 0; i < members_.size(); ++i) {
      positions_[i] = flat(position(surface_, points[members_[i]]));
      cells_[i] = cell_of(positions_[i]);
    }
    grid.build(cells_);
    return grid;
  }
  Cell cell_of(const Point2& p) const {
    return {static_cast<int>(std::floor(p.x() / radius_)), static_cast<int>(std::floor(p.y() / radius_)), 0};
  }

  Point2 force(std::size_t i, const CellHash& grid) const {
    const Point2& p = positions_[i];
    Point2 sum = Point2::Zero();
    // Collected without a branch: it cannot be predicted whether a point is near, and a misprediction costs more than
    // the test.
    thread_local std::vector<Index> near;
    std::size_t count = 0;
    grid.visit_block(cells_[i], 2, [&](Index j) {
      if (count == near.size()) near.resize(2 * count + 1);
      near[count] = j;
      count += static_cast<std::size_t>((p - positions_[j]).squaredNorm() <= radius_ * radius_ * kSurely);
    });
    for (std::size_t k = 0; k < count; ++k) {
      const Point2 away = p - positions_[near[k]];
      const double distance = away.norm();
      if (distance > 0 && distance < radius_) sum += (1 / distance - 1 / radius_) * away;
    }
    const double area_weight = (radius_ / spacing_) * (radius_ / spacing_), line_weight = line_density_ * radius_;
    edge_grid_.visit(cells_[i], [&](Index entry) {
      const Edge& edge = edges_[edge_in_cell_[entry]];
      const double along = (p - edge.start).dot(edge.along), h = (p - edge.start).dot(edge.inward) / radius_;
      if (along < 0 || along > edge.length || h < -1e-6 || h >= 1) return;
      sum += (area_weight * push_.of_area(h) + line_weight * push_.of_line(h)) * edge.inward;
    });
    return sum;
  }
  Point2 bounded(const Point2& step) const {
    const double length = step.norm(), longest = kLongestStep * spacing_;
    return length > longest ? Point2(step * (longest / length)) : step;
  }

  const Surface& surface_;
  const Clusters& clusters_;
  Index cluster_;
  std::vector<Index> members_;  // indices of the points
  const BoundaryPush& push_;
  double line_density_, spacing_ = 0, radius_ = 0;
  Point origin_;
  Vector u_, v_;  // axes in the plane of the cluster
  std::vector<Edge> edges_;
  std::vector<Index> edge_in_cell_;  // indices into edges_, for each entry of edge_grid_
  CellHash edge_grid_{Point::Zero(), 1};
  std::vector<Point2> positions_;  // of the points in members_
  std::vector<Cell> cells_;
};

}  // namespace

void relax_in_clusters(const Surface& surface, const Clusters& clusters, double line_density, int iterations,
                       std::vector<SurfacePoint>& points, const Progress& progress) {
  std::vector<std::vector<Index>> members(clusters.count());
  for (Index i = 0; i < points.size(); ++i) members[clusters.of_triangle[points[i].triangle]].push_back(i);
  const BoundaryPush push;
  std::vector<ClusterRelaxation> relaxations;
  for (Index c = 0; c < clusters.count(); ++c)
    if (!members[c].empty()) relaxations.emplace_back(surface, clusters, c, std::move(members[c]), line_density, push);
  for (int k = 0; k < iterations; ++k) {
    report_progress(progress, "relaxing surface points", static_cast<double>(k) / iterations);
    tbb::parallel_for(std::size_t{0}, relaxations.size(),
                      [&](std::size_t c) { relaxations[c].iterate(points, relaxation_step(k, iterations)); });
  }
}

}  // namespace orchard::detail
