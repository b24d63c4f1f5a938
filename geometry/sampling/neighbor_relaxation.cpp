#include "neighbor_relaxation.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "boundary_push.h"
#include "cell_hash.h"
#include "relaxation_constants.h"

namespace orchard::detail {
namespace {

// Parts of the surface whose normals have a smaller product do not act on each other. A right-angled edge of many small
// triangles is well above this.
constexpr double kFacesAway = -0.3;
// An edge pushes only the points whose normals agree with its own, even where several parts of the surface end at it.
constexpr double kSameSide = 0.5;
constexpr std::size_t kCellGrain = 64;  // cells of one task

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

  void iterate(std::vector<SurfacePoint>& points, double step_size) {
    CellHash grid = make_grid();
    parallel_over_points([&](std::size_t i) {
      positions_[i] = position(surface_, points[i]);
      normals_[i] = surface_.normal(points[i].triangle);
      triangles_[i] = points[i].triangle;
      cells_[i] = grid.cell_of(positions_[i]);
    });
    grid.build(cells_);
    const std::vector<Index> runs = grid.runs();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, runs.size() - 1, kCellGrain), [&](const auto& range) {
      Surroundings around;
      for (std::size_t run = range.begin(); run < range.end(); ++run) {
        look_around(grid.entry(runs[run]).cell, grid, around);
        for (Index e = runs[run]; e < runs[run + 1]; ++e)
          if (const Index i = grid.entry(e).item; i < count_) move(points[i], i, around, step_size);
      }
    });
  }

 private:
  struct Edge {
    Point start;
    Vector along, normal;
    double length;
  };

  // The points and edges that may act on the points of a cell. `near` has those of `points` that act on one of them.
  struct Surroundings {
    std::vector<Index> points, edges, near;
  };

  template <class Work>
  void parallel_over_points(const Work& work) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count_, kRelaxationGrain), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
    });
  }
  CellHash make_grid() const { return {surface_.bounding_box().min(), radius_}; }

  // Assigns the edges at which a walk ends to the cells that they pass through or near.
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
    for (int k = 0; k < pieces; ++k) {
      const Point from = edge.start + (k * (edge.length / pieces)) * edge.along;
      const Point to = edge.start + ((k + 1) * (edge.length / pieces)) * edge.along;
      const Cell low = edge_grid_.cell_of(from.cwiseMin(to)), high = edge_grid_.cell_of(from.cwiseMax(to));
      for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
          for (int x = low.x; x <= high.x; ++x) {
            cells.push_back({x, y, z});
            edge_in_cell_.push_back(static_cast<Index>(edges_.size() - 1));
          }
    }
  }

  void look_around(const Cell& cell, const CellHash& grid, Surroundings& out) const {
    out.points.clear();
    out.edges.clear();
    grid.visit_block(cell, 3, [&](Index j) { out.points.push_back(j); });
    if (edges_.empty()) return;
    edge_grid_.visit_block(cell, 3, [&](Index entry) { out.edges.push_back(edge_in_cell_[entry]); });
    std::sort(out.edges.begin(), out.edges.end());
    out.edges.erase(std::unique(out.edges.begin(), out.edges.end()), out.edges.end());
  }

  void move(SurfacePoint& point, Index i, Surroundings& around, double step_size) const {
    Vector step = step_size * spacing_ * force(i, around);
    const double length = step.norm(), longest = kLongestStep * spacing_;
    if (length > longest) step *= longest / length;
    SurfaceWalker(surface_).walk(point, step, [](Index, Index) { return true; });
  }

  Vector force(Index i, Surroundings& around) const {
    const Point& p = positions_[i];
    // Collected without a branch: it cannot be predicted whether a point is near, and a misprediction costs more than
    // the test.
    around.near.resize(around.points.size());
    std::size_t count = 0;
    for (const Index j : around.points) {
      const double squared = (p - positions_[j]).squaredNorm();
      around.near[count] = j;
      count += static_cast<std::size_t>(squared < radius_ * radius_) & static_cast<std::size_t>(squared > 0);
    }
    const Plane plane = plane_of(triangles_[i]);
    Vector sum = Vector::Zero();
    for (std::size_t k = 0; k < count; ++k) sum += repulsion(p, plane, around.near[k]);
    for (const Index edge : around.edges) sum += push(edges_[edge], p, plane.normal);
    return sum;
  }

  // The plane of a triangle, with the vectors needed to turn its neighbours into it.
  struct Plane {
    Index triangle;
    const Vector& normal;
    const std::array<Index, 3>& neighbors;
    std::array<Point, 3> corners;
    std::array<Vector, 3> along, outward;  // unit vectors along the edges, and across them
  };
  Plane plane_of(Index triangle) const {
    Plane plane{triangle, surface_.normal(triangle), surface_.neighbors(triangle), surface_.corners(triangle), {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      plane.along[i] = (plane.corners[(i + 1) % 3] - plane.corners[i]).normalized();
      plane.outward[i] = plane.along[i].cross(plane.normal);
    }
    return plane;
  }

  // Returns the force on a point at p from point j, which is in range, in the plane.
  Vector repulsion(const Point& p, const Plane& plane, Index j) const {
    const Vector away = p - positions_[j];
    const Index triangle = triangles_[j];
    if (triangle == plane.triangle) return repulsion(away);
    if (triangle != kNone)
      for (std::size_t edge = 0; edge < 3; ++edge)
        if (plane.neighbors[edge] == triangle) return repulsion(p - turned(positions_[j], plane, edge));
    if (plane.normal.dot(normals_[j]) < kFacesAway) return Vector::Zero();
    const Vector flat = away - away.dot(plane.normal) * plane.normal;
    const double length = flat.norm();
    return length > 0 ? Vector(((1 - away.norm() / radius_) / length) * flat) : Vector::Zero();
  }
  Vector repulsion(const Vector& away) const {
    const double distance = away.norm();
    return distance > 0 && distance < radius_ ? Vector((1 / distance - 1 / radius_) * away) : Vector::Zero();
  }
  static Point turned(const Point& q, const Plane& plane, std::size_t edge) {
    const Vector seen = q - plane.corners[edge], on = seen.dot(plane.along[edge]) * plane.along[edge];
    return plane.corners[edge] + on + (seen - on).norm() * plane.outward[edge];
  }
  Vector push(const Edge& edge, const Point& p, const Vector& normal) const {
    const double on = (p - edge.start).dot(edge.along);
    if (on < 0 || on > edge.length || normal.dot(edge.normal) < kSameSide) return Vector::Zero();
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
  // of the moving points, then of the fixed ones
  std::vector<Point> positions_;
  std::vector<Vector> normals_;
  std::vector<Index> triangles_;  // kNone for fixed points
  std::vector<Cell> cells_;
  std::vector<Edge> edges_;
  std::vector<Index> edge_in_cell_;  // indices into edges_, for each entry of edge_grid_
  CellHash edge_grid_;
};

}  // namespace

void relax_by_neighbors(const Surface& surface, const FixedPoints& fixed, int iterations,
                        std::vector<SurfacePoint>& points, const Progress& progress) {
  if (points.empty()) return;
  NeighborRelaxation relaxation(surface, fixed, points.size());
  for (int k = 0; k < iterations; ++k) {
    report_progress(progress, "relaxing surface points", static_cast<double>(k) / iterations);
    relaxation.iterate(points, relaxation_step(k, iterations));
  }
}

}  // namespace orchard::detail
