#include <algorithm>
#include <cmath>
#include <vector>

#include "orchard/covering/inaccuracy.h"

namespace orchard {
namespace {

// As for inaccuracy(): the bounds stay valid when it is met.
constexpr int kMostEvaluations = 200'000;

// A cube, with an upper bound on the signed distance over its part inside the ball.
struct Cell {
  double upper;
  Point center;
  double half;  // of the side
};
bool less_promising(const Cell& a, const Cell& b) { return a.upper < b.upper; }

class Search {
 public:
  Search(const Surface& surface, const Sphere& ball, double tolerance)
      : surface_(surface), ball_(ball), tolerance_(tolerance) {}

  Bounds run() {
    ClosestPoint nearest;
    everywhere_ = distance_bound(surface_.signed_distance(ball_.center, nearest), ball_.radius);
    anchor_ = nearest.position;
    if (everywhere_ <= 0 || ball_.radius <= 0) return {0, everywhere_};
    evaluate(ball_.center, ball_.radius);
    while (!cells_.empty() && evaluations_ < kMostEvaluations && cells_.front().upper > best_ + tolerance_) {
      std::pop_heap(cells_.begin(), cells_.end(), less_promising);
      const Cell cell = cells_.back();
      cells_.pop_back();
      for (int octant = 0; octant < 8; ++octant) {
        const Vector step((octant & 1) ? 1 : -1, (octant & 2) ? 1 : -1, (octant & 4) ? 1 : -1);
        evaluate(cell.center + cell.half / 2 * step, cell.half / 2);
      }
    }
    const double open = cells_.empty() ? 0 : cells_.front().upper;
    return {best_, std::min(everywhere_, std::max({best_, dropped_, open}))};
  }

 private:
  void evaluate(const Point& center, double half) {
    // The representative is the cube's centre, drawn into the ball: every point of the part inside the ball is as near
    // to it as to the centre, since drawing points into a convex set brings them no farther from its points.
    const Vector out = center - ball_.center;
    const double away = out.norm(), reach = half * kHalfDiagonal;
    if (away > ball_.radius + reach) return;
    const Point sample = away > ball_.radius ? Point(ball_.center + out * (ball_.radius / away)) : center;
    ++evaluations_;
    ClosestPoint nearest;
    const double value = surface_.signed_distance(sample, nearest);
    best_ = std::max(best_, value);
    const double upper = std::min({value + reach, farthest(nearest.position, center, half),
                                   farthest(anchor_, center, half), everywhere_}) *
                         (1 + 1e-12);
    if (upper <= best_ + 0.5 * tolerance_) {
      dropped_ = std::max(dropped_, upper);
      return;
    }
    cells_.push_back({upper, center, half});
    std::push_heap(cells_.begin(), cells_.end(), less_promising);
  }

  // The largest distance from y to a point of both the cube and the ball, or more.
  double farthest(const Point& y, const Point& center, double half) const {
    const Vector corner = (y - center).cwiseAbs() + Vector::Constant(half);
    return std::min(corner.norm(), (y - ball_.center).norm() + ball_.radius);
  }

  static constexpr double kHalfDiagonal = 1.7320508075688774;
  const Surface& surface_;
  const Sphere ball_;
  const double tolerance_;
  Point anchor_ = Point::Zero();
  double everywhere_ = 0, best_ = 0, dropped_ = 0;
  int evaluations_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace

Bounds farthest_from_solid(const Surface& surface, const Sphere& ball, double tolerance) {
  return Search(surface, ball, std::max(tolerance, 1e-6) * surface.bounding_radius()).run();
}

}  // namespace orchard
