#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A ball with the signed distance of its centre. Its looseness, radius + center_distance, bounds Hubbard's inaccuracy
// from above, equals it where the object is convex, and is never negative for a ball that holds a point of the surface.
struct FittedBall {
  Point center = Point::Zero();
  double radius = 0;
  double center_distance = 0;  // signed distance of the centre, negative inside
  double looseness() const { return radius + center_distance; }
  // With the radius that the ball needs to reach the point, whatever it has now.
  double looseness_with(const Point& point) const { return (point - center).norm() + center_distance; }
};

// Fits one ball to points: minimises the looseness max |p - c| + sd(c) over the centre c by a bundle method. The first
// term is linearised at the points that are farthest or may become so within the step, the second by the gradients of
// sd at the centres visited; a step that does not help shrinks the next one. Finds a local minimum. Keeps scratch: one
// fitter per thread.
class BallFitter {
 public:
  explicit BallFitter(const Surface& surface) : surface_(surface) {}

  // The ball holds all points. Precondition: there is one. At most `evaluations` queries of the signed distance.
  FittedBall fit(std::span<const Point> points, const Point& start, int evaluations);

 private:
  struct Term {  // value and gradient at the present centre
    double value;
    Vector gradient;
  };
  struct Cut {  // sd(c) is about value + gradient . (c - at)
    Point at;
    double value;
    Vector gradient;
  };
  Cut cut_at(const Point& center) const;
  void linearise(std::span<const Point> points, const FittedBall& ball, double reach);
  Vector best_step(double proximity);
  double predicted_looseness(const Vector& step) const;

  const Surface& surface_;
  std::vector<Cut> cuts_;
  std::vector<Term> far_, near_;
  std::vector<double> far_weight_, near_weight_;
};

}  // namespace orchard::detail
