#include "neighbor_relaxation.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "boundary_push.h"
#include "cell_hash.h"
#include "relaxation_constants.h"

namespace orchard::detail {
namespace {

// Surface parts whose normals have a smaller product are different sheets. A right-angled edge of many small triangles
// is well within.
constexpr double kFacesAway = -0.3;

class NeighborRelaxation {
 public:
  NeighborRelaxation(const Surface& surface, const FixedPoints& fixed, std::size_t count)
      : surface_(surface),
        count_(count),
        positions_(count),
        normals_(count),
        triangles_(count),
        cells_(count),
        edge_grid_(Point::Zero(), 1) {
    double area = 0;
    for (Index t = 0; t < surface.mesh().triangles.size(); ++t) area += surface.area(t);
    spacing_ = std::sqrt(area / static_cast<double>(count + fixed.positions.size()));
    radius_ = kRepulsionRadius * spacing_;
    positions_.insert(positions_.end(), fixed.positions.begin(), fixed.positions.end());
    normals_.insert(normals_.end(), fixed.normals.begin(), fixed.normals.end());
    triangles_.resize(positions_.size(), kNone);
    const CellHash grid = make_grid();
    for (const Point& p : fixed.positions) cells_.push_back(grid.cell_of(p));
    collect_edges();
  }

  void iterate(std::vector<SurfacePoint>& points) {
    CellHash grid = make_grid();
    parallel_over_points([&](std::size_t i) {
      positions_[i] = position(surface_, points[i]);
      normals_[i] = surface_.normal(points[i].triangle);
      triangles_[i] = points[i].triangle;
      cells_[i] = grid.cell_of(positions_[i]);
    });
    grid.build(cells_);
    const std::vector<Index> runs = grid.runs();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, runs.size() - 1, kRelaxationGrain / 4),
                      [&](const auto& range) {
                        std::vector<Index> around;
                        for (std::size_t run = range.begin(); run < range.end(); ++run) {
                          around.clear();
                          grid.visit_block(grid.entry(runs[run]).cell, 3, [&](Index j) { around.push_back(j); });
                          for (Index e = runs[run]; e < runs[run + 1]; ++e)
                            if (const Index i = grid.entry(e).item; i < count_) move(points[i], i, around);
                        }
                      });
  }

 private:
  struct Edge {
    Point start;
    Vector along, normal;
    double length;
  };

  template <class Work>
  void parallel_over_points(const Work& work) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count_, kRelaxationGrain), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
    });
  }
  CellHash make_grid() const { return {surface_.bounding_box().min(), radius_}; }

  // The edges where a walk ends, in the cells that come within the radius of them.
  void collect_edges() {
    edge_grid_ = make_grid();
    std::vector<Cell> cells;
    for (Index t = 0; t < surface_.mesh().triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (surface_.neighbors(t)[i] != kNone || surface_.area(t) == 0) continue;
        const auto p = surface_.corners(t);
        const Vector edge = p[(i + 1) % 3] - p[i];
        edges_.push_back({p[i], edge.normalized(), surface_.normal(t), edge.norm()});
        add_cells(cells);
      }
    }
    edge_grid_.build(cells);
  }
  void add_cells(std::vector<Cell>& cells) {
    const Edge& edge = edges_.back();
    const int pieces = 1 + static_cast<int>(edge.length / radius_);
    std::vector<Cell> own;
    for (int k = 0; k < pieces; ++k) {
      const Point from = edge.start + (k * (edge.length / pieces)) * edge.along;
      const Point to = edge.start + ((k + 1) * (edge.length / pieces)) * edge.along;
      const Vector margin = Vector::Constant(radius_);
      const Cell low = edge_grid_.cell_of(from.cwiseMin(to) - margin);
      const Cell high = edge_grid_.cell_of(from.cwiseMax(to) + margin);
      for (int z = low[2]; z <= high[2]; ++z)
        for (int y = low[1]; y <= high[1]; ++y)
          for (int x = low[0]; x <= high[0]; ++x) own.push_back({x, y, z});
    }
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    cells.insert(cells.end(), own.begin(), own.end());
    edge_in_cell_.insert(edge_in_cell_.end(), own.size(), static_cast<Index>(edges_.size() - 1));
  }

  void move(SurfacePoint& point, Index i, std::span<const Index> around) const {
    Vector step = kRelaxationStep * spacing_ * force(i, around);
    const double length = step.norm(), longest = kLongestStep * spacing_;
    if (length > longest) step *= longest / length;
    SurfaceWalker(surface_).walk(point, step, [](Index, Index) { return true; });
  }

  Vector force(Index i, std::span<const Index> around) const {
    const Point& p = positions_[i];
    Vector sum = Vector::Zero();
    for (const Index j : around) {
      const Vector away = p - positions_[j];
      const double squared = away.squaredNorm();
      if (squared < radius_ * radius_ && squared > 0) sum += repulsion(i, j, away, std::sqrt(squared));
    }
    edge_grid_.visit(cells_[i], [&](Index entry) { sum += push(edges_[edge_in_cell_[entry]], p, normals_[i]); });
    return sum;
  }

  // In the plane of point i.
  Vector repulsion(Index i, Index j, const Vector& away, double distance) const {
    if (triangles_[j] == triangles_[i]) return (1 / distance - 1 / radius_) * away;
    if (triangles_[j] != kNone) {
      const auto& neighbors = surface_.neighbors(triangles_[i]);
      for (std::size_t edge = 0; edge < 3; ++edge)
        if (neighbors[edge] == triangles_[j]) return repulsion_across(i, j, edge);
    }
    const Vector& normal = normals_[i];
    if (normal.dot(normals_[j]) < kFacesAway) return Vector::Zero();
    const Vector flat = away - away.dot(normal) * normal;
    const double length = flat.norm();
    return length > 0 ? Vector(((1 - distance / radius_) / length) * flat) : Vector::Zero();
  }
  Vector repulsion_across(Index i, Index j, std::size_t edge) const {
    const auto p = surface_.corners(triangles_[i]);
    const Vector along = (p[(edge + 1) % 3] - p[edge]).normalized();
    const Vector outward = along.cross(normals_[i]);
    const Vector seen = positions_[j] - p[edge];
    const double on = seen.dot(along);
    const Point turned = p[edge] + on * along + (seen - on * along).norm() * outward;
    const Vector away = positions_[i] - turned;
    const double distance = away.norm();
    return distance > 0 && distance < radius_ ? Vector((1 / distance - 1 / radius_) * away) : Vector::Zero();
  }
  Vector push(const Edge& edge, const Point& p, const Vector& normal) const {
    const double on = (p - edge.start).dot(edge.along);
    if (on < 0 || on > edge.length || normal.dot(edge.normal) < kFacesAway) return Vector::Zero();
    const Vector away = p - edge.start - on * edge.along;
    const double h = away.norm() / radius_;
    const Vector flat = away - away.dot(normal) * normal;
    const double length = flat.norm();
    if (h >= 1 || length == 0) return Vector::Zero();
    return (kRepulsionRadius * kRepulsionRadius * push_.of_area(h) / length) * flat;
  }

  const Surface& surface_;
  std::size_t count_;
  const BoundaryPush push_;
  double spacing_ = 0, radius_ = 0;
  // Of the moving points, then of the fixed ones.
  std::vector<Point> positions_;
  std::vector<Vector> normals_;
  std::vector<Index> triangles_;  // kNone for fixed points
  std::vector<Cell> cells_;
  std::vector<Edge> edges_;
  std::vector<Index> edge_in_cell_;  // into edges_, for each entry of edge_grid_
  CellHash edge_grid_;
};

}  // namespace

void relax_by_neighbors(const Surface& surface, const FixedPoints& fixed, int iterations,
                        std::vector<SurfacePoint>& points, const Progress& progress) {
  if (points.empty()) return;
  NeighborRelaxation relaxation(surface, fixed, points.size());
  for (int k = 0; k < iterations; ++k) {
    report_progress(progress, "relaxing surface points", static_cast<double>(k) / iterations);
    relaxation.iterate(points);
  }
}

}  // namespace orchard::detail
