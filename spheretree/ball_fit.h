#pragma once
#include <span>
#include <vector>

#include "far_points.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// What a ball is fitted by. Its reach, radius + signed distance of the centre, bounds the inaccuracy wherever the solid
// is. It is far above it for a ball that holds much surface on all sides of its centre, as of a lattice or of many
// parts: there the smallest ball is mostly the tightest.
enum class BallMeasure { reach, radius };

// A ball with the signed distance of its centre, or 0 for it if balls are measured by their radius. Its looseness,
// radius + center_distance, bounds Hubbard's inaccuracy from above, equals it where the object is convex, and is never
// negative for a ball that holds a point of the surface.
struct FittedBall {
  Point center = Point::Zero();
  double radius = 0;
  double center_distance = 0;     // signed distance of the centre, negative inside
  Vector slope = Vector::Zero();  // its gradient there, of length one; zero: not known
  double looseness() const { return radius + center_distance; }
  // With the radius that the ball needs to reach the point, whatever it has now.
  double looseness_with(const Point& point) const { return (point - center).norm() + center_distance; }
};

// Fits one ball to points: minimises the looseness max |p - c| + sd(c) over the centre c by a bundle method. The first
// term is linearised at the points that are farthest or may become so within the step, the second by the gradients of
// sd at the centres visited; a step that does not help shrinks the next one. Finds a local minimum. Keeps scratch: one
// fitter per thread.
// Hidden: what a shared library could replace is not inlined.
class [[gnu::visibility("hidden")]] BallFitter {
 public:
  explicit BallFitter(const Surface& surface, BallMeasure measure = BallMeasure::reach)
      : surface_(surface), measure_(measure) {}

  // The ball holds all points. Precondition: there is one. At most `evaluations` queries of the signed distance. A
  // start whose slope is known must have the distance that belongs to it.
  FittedBall fit(std::span<const Point> points, const FittedBall& start, int evaluations);
  FittedBall fit(std::span<const Point> points, const Point& start, int evaluations) {
    return fit(points, at(start), evaluations);
  }
  // A ball of no size, with what is to be known of its centre.
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
  // What the looseness is the largest of, as seen from the present centre: value + gradient . step. The weights are
  // those of the dual.
  template <std::size_t kRoom>
  struct Terms {
    Lanes value[kRoom / kLanes], x[kRoom / kLanes], y[kRoom / kLanes], z[kRoom / kLanes];
    double weight[kRoom];         // of those in `weighted`; of all others 0
    std::size_t weighted[kRoom];  // few of all terms
    std::size_t count = 0, weighted_count = 0;

    void add(double term, const Vector& gradient);
    void fill_up();  // the last four, so that they can be looked at together
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
  std::vector<FourNumbers> squared_, measured_;  // distances of the points from the best centre, from the last one
  FarPoints farthest_;
  Terms<kMaxFar> far_;
  Terms<kMaxCuts> near_;
};

}  // namespace orchard::detail
