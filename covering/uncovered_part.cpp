#include "orchard/covering/uncovered_part.h"

#include <algorithm>
#include <queue>

namespace orchard {
namespace {

struct Cell {
  std::array<Point, 3> corners;
  double area, reach;  // reach: of the farthest corner from the middle
  double distance;     // at the middle
  Point middle() const { return (corners[0] + corners[1] + corners[2]) / 3; }
  double farthest() const { return distance + reach; }
};
struct Smaller {
  bool operator()(const Cell& a, const Cell& b) const { return a.area < b.area; }
};
struct Shallower {
  bool operator()(const Cell& a, const Cell& b) const { return a.farthest() < b.farthest(); }
};

class Measurer {
 public:
  Measurer(const PathForest& forest, double radius, const UncoveredPartOptions& options)
      : forest_(forest), radius_(radius), options_(options) {}

  void add(const std::array<Point, 3>& corners) {
    const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    classify(corners, area);
  }

  UncoveredPart run() {
    while (!open_.empty() && cells_ < options_.max_cells &&
           open_area_ > std::max(options_.area_tolerance * sure_area_, kNoArea * radius_ * radius_)) {
      const Cell cell = open_.top();
      open_.pop();
      open_area_ -= cell.area;
      if (cell.area == 0 || cell.reach <= kFinest * radius_) {
        settled_.push_back(cell);
        settled_area_ += cell.area;
        continue;
      }
      for_each_half(cell, [&](const auto& corners) { classify(corners, cell.area / 2); });
    }
    part_.area = {sure_area_, sure_area_ + std::max(0.0, open_area_) + settled_area_};
    part_.likely_area = sure_area_;
    for (const Cell& cell : settled_)
      if (cell.distance > 0 && cell.distance <= cell.reach) part_.likely_area += cell.area;
    bound_distance();
    return part_;
  }

 private:
  // Cells smaller than this fraction of R remain undecided, because rounding of their corners begins to matter.
  static constexpr double kFinest = 1e-9;
  // Areas below this fraction of R^2 count as zero.
  static constexpr double kNoArea = 1e-9;

  // Halves a cell across its longest side, so that the parts of a needle soon have a better shape.
  template <class Visit>
  static void for_each_half(const Cell& cell, Visit visit) {
    std::size_t longest = 0;
    double length = 0;
    for (std::size_t side = 0; side < 3; ++side) {
      const double own = (cell.corners[(side + 1) % 3] - cell.corners[side]).squaredNorm();
      if (own > length) length = own, longest = side;
    }
    const Point &a = cell.corners[longest], &b = cell.corners[(longest + 1) % 3], &c = cell.corners[(longest + 2) % 3];
    const Point middle = (a + b) / 2;
    visit(std::array<Point, 3>{a, middle, c});
    visit(std::array<Point, 3>{middle, b, c});
  }

  // Adds a cell to the uncovered or to the undecided ones, or drops it if it is covered.
  void classify(const std::array<Point, 3>& corners, double area) {
    ++cells_;
    const Cell cell = make_cell(corners, area);
    if (cell.farthest() <= 0) return;
    if (cell.distance > cell.reach) {
      sure_area_ += area;
      settled_.push_back(cell);
      return;
    }
    if (covered(corners)) return;
    open_area_ += area;
    open_.push(cell);
  }

  bool covered(const std::array<Point, 3>& corners) {
    forest_.gather(corners, near_);
    return triangle_covered(corners, near_.balls);
  }

  Cell make_cell(const std::array<Point, 3>& corners, double area) {
    Cell cell{corners, area, 0, 0};
    const Point middle = cell.middle();
    for (const Point& corner : corners) cell.reach = std::max(cell.reach, (corner - middle).norm());
    cell.reach *= 1 + 1e-12;
    for (const Point& point : {middle, corners[0], corners[1], corners[2]}) {
      const double distance = forest_.distance(point);
      if (point == middle) cell.distance = distance;
      if (distance <= part_.distance.lower) continue;
      part_.distance.lower = distance;
      part_.farthest = point;
    }
    return cell;
  }

  // Bounds the largest distance. Empties open_.
  void bound_distance() {
    std::priority_queue<Cell, std::vector<Cell>, Shallower> cells;
    for (; !open_.empty(); open_.pop()) {
      cells.push(open_.top());
      if (open_.top().distance > 0) part_.likely_area += open_.top().area;
    }
    for (const Cell& cell : settled_) cells.push(cell);
    const auto width = [&] {
      return std::max(options_.distance_tolerance.of_radius * radius_,
                      options_.distance_tolerance.of_distance * part_.distance.lower);
    };
    for (Index spent = 0; !cells.empty() && spent < options_.max_cells; spent += 2) {
      const Cell cell = cells.top();
      if (cell.farthest() <= part_.distance.lower + width()) break;
      cells.pop();
      for_each_half(cell, [&](const auto& corners) {
        const Cell half = make_cell(corners, cell.area / 2);
        if (half.farthest() > 0 && (half.distance > half.reach || !covered(corners))) cells.push(half);
      });
    }
    part_.distance.upper =
        cells.empty() ? part_.distance.lower : std::max(part_.distance.lower, cells.top().farthest());
  }

  const PathForest& forest_;
  const double radius_;
  const UncoveredPartOptions& options_;
  std::priority_queue<Cell, std::vector<Cell>, Smaller> open_;
  std::vector<Cell> settled_;  // cells that are uncovered, or too small to decide
  double open_area_ = 0, sure_area_ = 0, settled_area_ = 0;
  Index cells_ = 0;
  NearBalls near_;
  UncoveredPart part_;
};

}  // namespace

UncoveredPart uncovered_part(const Surface& surface, std::span<const Index> triangles, const PathForest& forest,
                             const Point& origin, const UncoveredPartOptions& options) {
  Measurer measurer(forest, surface.bounding_radius(), options);
  for (Index triangle : triangles) {
    auto corners = surface.corners(triangle);
    for (Point& corner : corners) corner -= origin;
    measurer.add(corners);
  }
  return measurer.run();
}

}  // namespace orchard
