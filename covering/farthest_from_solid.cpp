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

// A cube, with an upper bound on the signed distance over its part inside the ball.
struct Cube {
  double upper;
  Point center;
  double half;    // of the side
  Point nearest;  // of the surface, to about the centre

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

  // Only as far as it takes to tell whether the limit holds.
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

  // How far the bounds may be apart, given the lower one.
  double width() const {
    return std::max({tolerance_.of_radius * radius_, tolerance_.of_distance * best_, detail::kFinest * radius_});
  }

  // `known`: a point of the surface; often it does.
  void evaluate(const Point& center, double half, const Point& known) {
    // The representative is the cube's centre, drawn into the ball: every point of the part inside the ball is as near
    // to it as to the centre, since drawing points into a convex set brings them no farther from its points.
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

  // A cell that cannot matter is dropped, but its bound counts towards the answer's.
  bool does_not_matter(double upper) {
    if (upper > limit_ && (limit_ >= 0 || upper > best_ + 0.5 * width())) return false;
    dropped_ = std::max(dropped_, upper);
    return true;
  }

  // The largest distance from y to a point of both the cube and the ball, or more.
  double farthest(const Point& y, const Point& center, double half) const {
    const Vector corner = (y - center).cwiseAbs() + Vector::Constant(half);
    return std::min({corner.norm(), (y - ball_.center).norm() + ball_.radius, farthest_in_cone(y, center, half)});
  }

  // The same over the part of the ball that a cone around the cube leaves between two spheres. Where the cube lies at
  // the ball's rim across from y, this is above the truth by the square of the cube's size only.
  double farthest_in_cone(const Point& y, const Point& center, double half) const {
    const Vector out = center - ball_.center, to_y = y - ball_.center;
    const double away = out.norm(), reach = half * kHalfDiagonal, length = to_y.norm();
    if (away <= reach) return std::numeric_limits<double>::infinity();
    const double half_chord =
        detail::HalfAngle::between(out, away, to_y, length).half_chord_with(detail::HalfAngle::of_sine(reach / away));
    // The squared distance is convex in the distance from the ball's centre: the ends suffice.
    const auto squared = [&](double r) {
      return (r - length) * (r - length) + 4 * r * length * half_chord * half_chord;
    };
    const double nearest = away - reach, farthest = std::min(away + reach, ball_.radius);
    return std::sqrt(std::max(squared(nearest), squared(farthest))) + kRounding * (away + reach + length);
  }

  static constexpr double kRounding = 1e-13;  // of the lengths in a bound: a few hundred times what they are off by
  static constexpr double kHalfDiagonal = 1.7320508075688774;
  const Surface& surface_;
  const detail::InteriorSurface interior_;
  const Sphere ball_;
  const double radius_;  // R
  const DistanceTolerance tolerance_;
  double limit_ = -1;  // < 0: none
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
