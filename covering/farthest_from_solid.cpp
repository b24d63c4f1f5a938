#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "half_angle.h"
#include "interior_surface.h"
#include "orchard/covering/inaccuracy.h"
#include "search_limits.h"

namespace orchard {
namespace {

// A cube, with an upper bound on the signed distance over the part of it that is inside the ball.
struct Cube {
  double upper;
  Point center;
  double half;    // half of the side length
  Point nearest;  // the place of the surface that is nearest to the centre

  static bool less_promising(const Cube& a, const Cube& b) { return a.upper < b.upper; }
};

class CubeSearch {
 public:
  CubeSearch(const Surface& surface, const Sphere& ball, const DistanceTolerance& tolerance)
      : surface_(surface), interior_(surface), ball_(ball), radius_(surface.bounding_radius()), tolerance_(tolerance) {}

  Bounds run(double at_least) {
    start();
    best_ = std::max(best_, at_least);
    while (open() && cells_.front().upper > best_ + width()) split_most_promising();
    return bounds();
  }

  // Runs only until it is known whether the limit holds.
  Bounds run_against(double limit) {
    limit_ = limit;
    start();
    while (open() && cells_.front().upper > limit && best_ <= limit) split_most_promising();
    return bounds();
  }
  const Point& where_lower() const { return at_; }

 private:
  void start() {
    ClosestPoint nearest;
    at_ = ball_.center;
    const double center = surface_.signed_distance(ball_.center, nearest);
    everywhere_ = distance_bound(center, ball_.radius);
    best_ = std::max(0.0, center);
    anchor_ = nearest.position;
    if (everywhere_ > best_ && everywhere_ > limit_) evaluate(ball_.center, ball_.radius, anchor_);
  }
  bool open() const { return !cells_.empty() && evaluations_ < detail::kMaxEvaluations; }
  Bounds bounds() const {
    if (evaluations_ == 0) return {best_, everywhere_};
    const double left = cells_.empty() ? 0 : cells_.front().upper;
    return {best_, std::min(everywhere_, std::max({best_, dropped_, left}))};
  }

  void split_most_promising() {
    std::pop_heap(cells_.begin(), cells_.end(), Cube::less_promising);
    const Cube cell = cells_.back();
    cells_.pop_back();
    for (int octant = 0; octant < 8; ++octant) {
      const Vector step((octant & 1) ? 1 : -1, (octant & 2) ? 1 : -1, (octant & 4) ? 1 : -1);
      evaluate(cell.center + cell.half / 2 * step, cell.half / 2, cell.nearest);
    }
  }

  // Returns how far apart the bounds may be, given the lower bound.
  double width() const {
    return std::max({tolerance_.of_radius * radius_, tolerance_.of_distance * best_, detail::kFinest * radius_});
  }

  // `known` is a place of the surface, which often suffices.
  void evaluate(const Point& center, double half, const Point& known) {
    // The representative is the cube's centre, moved to the nearest point of the ball. Every point of the part inside
    // the ball is at least as near to it as to the centre, because moving a point into a convex set brings it no
    // farther from the points of the set.
    const Vector out = center - ball_.center;
    const double away = out.norm(), reach = half * kHalfDiagonal;
    if (away > ball_.radius + reach) return;
    const double bound = std::min(farthest(known, center, half), everywhere_) * (1 + 1e-12);
    if (does_not_matter(bound)) return;
    const Point sample = away > ball_.radius ? Point(ball_.center + out * (ball_.radius / away)) : center;
    ++evaluations_;
    ClosestPoint nearest;
    const double value = surface_.signed_distance(sample, nearest);
    if (value > best_) best_ = value, at_ = sample;
    const double upper = std::min({value + reach, farthest(nearest.position, center, half),
                                   farthest(anchor_, center, half), everywhere_}) *
                         (1 + 1e-12);
    if (does_not_matter(upper)) return;
    if (value <= interior_.depth() && interior_.fill({sample, reach}) && does_not_matter(interior_.depth())) return;
    cells_.push_back({upper, center, half, nearest.position});
    std::push_heap(cells_.begin(), cells_.end(), Cube::less_promising);
  }

  // A cell that cannot change the result is dropped, but its bound is part of the result's upper bound.
  bool does_not_matter(double upper) {
    if (upper > limit_ && (limit_ >= 0 || upper > best_ + 0.5 * width())) return false;
    dropped_ = std::max(dropped_, upper);
    return true;
  }

  // Returns at least the largest distance from y to a point that is in both the cube and the ball.
  double farthest(const Point& y, const Point& center, double half) const {
    const Vector corner = (y - center).cwiseAbs() + Vector::Constant(half);
    return std::min({corner.norm(), (y - ball_.center).norm() + ball_.radius, farthest_in_cone(y, center, half)});
  }

  // The same over the part of the ball that lies in a cone around the cube and between two spheres. If the cube is at
  // the rim of the ball opposite to y, this is too large only by the square of the cube's size.
  double farthest_in_cone(const Point& y, const Point& center, double half) const {
    const Vector out = center - ball_.center, to_y = y - ball_.center;
    const double away = out.norm(), reach = half * kHalfDiagonal, length = to_y.norm();
    if (away <= reach) return std::numeric_limits<double>::infinity();
    const double half_chord =
        detail::HalfAngle::between(out, away, to_y, length).half_chord_with(detail::HalfAngle::of_sine(reach / away));
    // The squared distance is a convex function of the distance from the ball's centre, so it is largest at one of the
    // ends.
    const auto squared = [&](double r) {
      return (r - length) * (r - length) + 4 * r * length * half_chord * half_chord;
    };
    const double nearest = away - reach, farthest = std::min(away + reach, ball_.radius);
    return std::sqrt(std::max(squared(nearest), squared(farthest))) + kRounding * (away + reach + length);
  }

  // As a fraction of the lengths in a bound: a few hundred times their rounding error.
  static constexpr double kRounding = 1e-13;
  static constexpr double kHalfDiagonal = 1.7320508075688774;
  const Surface& surface_;
  const detail::InteriorSurface interior_;
  const Sphere ball_;
  const double radius_;  // the bounding radius R
  const DistanceTolerance tolerance_;
  double limit_ = -1;  // below 0 if there is no limit
  Point anchor_ = Point::Zero(), at_ = Point::Zero();
  double everywhere_ = 0, best_ = 0, dropped_ = 0;
  int evaluations_ = 0;
  std::vector<Cube> cells_;
};

}  // namespace

Bounds farthest_from_solid(const Surface& surface, const Sphere& ball, const DistanceTolerance& tolerance,
                           double at_least) {
  return CubeSearch(surface, ball, tolerance).run(at_least);
}

Bounds farthest_against(const Surface& surface, const Sphere& ball, double limit, Point& at) {
  CubeSearch search(surface, ball, {});
  const Bounds bounds = search.run_against(std::max(0.0, limit));
  at = search.where_lower();
  return bounds;
}

}  // namespace orchard
