#pragma once
#include <span>
#include <vector>

#include "far_points.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// The measure that a fit minimises. The reach of a ball, radius + signed distance of the centre, is an upper bound on
// the inaccuracy for every solid. It is far above the inaccuracy for a ball that contains a lot of surface on all sides
// of its centre, such as one around a lattice or around many parts. For such a ball, the smallest radius is usually the
// tightest choice.
enum class BallMeasure { reach, radius };

// A ball with the signed distance of its centre, or 0 in place of that if balls are measured by their radius. Its
// looseness, radius + center_distance, bounds Hubbard's inaccuracy from above, equals it if the object is convex, and
// is never negative for a ball that contains a point of the surface.
struct FittedBall {
  Point center = Point::Zero();
  double radius = 0;
  double center_distance = 0;  // signed distance of the centre, negative inside
  // The gradient of the signed distance at the centre, of length one; zero if it is not known.
  Vector slope = Vector::Zero();
  double looseness() const { return radius + center_distance; }
  // Returns the looseness with the radius that the ball needs to reach the point.
  double looseness_with(const Point& point) const { return (point - center).norm() + center_distance; }
};

// Fits a ball to points: it minimises the looseness max |p - c| + sd(c) over the centre c by a bundle method. The first
// term is linearised at the points that are farthest or may become so within the step, and the second by the gradients
// of sd at the centres visited. A step that does not help shrinks the next one. Finds a local minimum. A fitter keeps
// memory between calls, so each thread needs its own.
// Its visibility is hidden, because functions that a shared library may replace are not inlined.
class [[gnu::visibility("hidden")]] BallFitter {
 public:
  explicit BallFitter(const Surface& surface, BallMeasure measure = BallMeasure::reach)
      : surface_(surface), measure_(measure) {}

  // Fits a ball that contains all points, of which there must be at least one, with at most `evaluations` queries of
  // the signed distance. If the slope of `start` is known, its distance must be the one at its centre.
  FittedBall fit(std::span<const Point> points, const FittedBall& start, int evaluations);
  FittedBall fit(std::span<const Point> points, const Point& start, int evaluations) {
    return fit(points, at(start), evaluations);
  }
  // Returns a ball of radius 0 with the distance and slope at its centre.
  FittedBall at(const Point& center) const;

 private:
  static constexpr std::size_t kLanes = FourNumbers::kLanes;
  using Lanes = FourNumbers::Lanes;
  struct FourPoints {
    Lanes x, y, z;
  };
  struct Cut {  // sd(c) is about value + gradient . (c - at)
    Point at;
    double value;
    Vector gradient;
  };
  // The terms whose largest value is the looseness, as seen from the present centre: value + gradient . step. The
  // weights are those of the dual problem.
  template <std::size_t kRoom>
  struct Terms {
    Lanes value[kRoom / kLanes], x[kRoom / kLanes], y[kRoom / kLanes], z[kRoom / kLanes];
    double weight[kRoom];         // the weights of the terms in `weighted`; those of all others are 0
    std::size_t weighted[kRoom];  // the few terms that have a weight
    std::size_t count = 0, weighted_count = 0;

    void add(double term, const Vector& gradient);
    void fill_up();  // fills up the last group of four, so that all groups can be processed alike
    Vector start_weights();
    double shift_weight(Vector& sum, double t);
    double max_after(const Vector& step) const;

   private:
    Vector gradient(std::size_t i) const;
  };
  static constexpr std::size_t kMaxFar = FarPoints::kMax;
  static constexpr std::size_t kMaxCuts = 12;

  FittedBall fit_here(std::span<const Point> points, const FittedBall& start, int evaluations);
  FittedBall fit_wide(std::span<const Point> points, const FittedBall& start, int evaluations);
  Cut cut_at(const Point& center) const;
  ClosestPoint closest(const Point& center) const;
  void take_points(std::span<const Point> points);
  double measure(const Point& center);
  void linearise(const FittedBall& ball, double reach);
  void linearise_points(const FittedBall& ball, double reach);
  Vector best_step(double proximity);
  double predicted_looseness(const Vector& step) const { return far_.max_after(step) + near_.max_after(step); }

  const Surface& surface_;
  const BallMeasure measure_;
  std::vector<Cut> cuts_;
  std::size_t point_count_ = 0;
  std::vector<FourPoints> points_;
  // Squared distances of the points from the best centre, and from the last one.
  std::vector<FourNumbers> squared_, measured_;
  FarPoints farthest_;
  Terms<kMaxFar> far_;
  Terms<kMaxCuts> near_;
};

}  // namespace orchard::detail
