#include "sharp_ends.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace orchard::detail {
namespace {

Vector direction(const ExactBall& ball, int i) {
  return (ball.contacts[static_cast<std::size_t>(i)].position - ball.center) / ball.radius;
}

}  // namespace

bool apex_of_two(const ExactBall& ball, int i, int j, Vector& to_apex) {
  const Vector u = direction(ball, i), w = direction(ball, j);
  const Vector sum = u + w;
  // The half square of |sum| is 1 + u w, so the vector sum / (1 + u w) has length 2 / |sum|.
  if (!(sum.norm() * kMaxApex > 2)) return false;
  to_apex = ball.radius * 2 * sum / sum.squaredNorm();
  return true;
}

bool apex_of_three(const ExactBall& ball, int i, int j, int k, Vector& to_apex) {
  Eigen::Matrix3d normals;
  normals << direction(ball, i).transpose(), direction(ball, j).transpose(), direction(ball, k).transpose();
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(normals);
  if (!lu.isInvertible()) return false;
  to_apex = ball.radius * lu.solve(Vector::Ones());
  return to_apex.norm() <= kMaxApex * ball.radius;
}

bool is_way_right(const Surface& surface, const ExactBall& ball, const Point& end, double tolerance) {
  const double length = (end - ball.center).norm();
  for (const double t : {0.25, 0.5, 0.75, 0.9}) {
    const Point center = (1 - t) * ball.center + t * end;
    if (ball_error(surface, center, (1 - t) * ball.radius, length) > tolerance) return false;
  }
  return true;
}

bool is_triangle_right(const Surface& surface, const ExactBall& a, const ExactBall& b, const ExactBall& c,
                       double tolerance) {
  const double reach = std::max((a.center - b.center).norm(), (a.center - c.center).norm());
  return ball_error(surface, (a.center + b.center + c.center) / 3, (a.radius + b.radius + c.radius) / 3, reach) <=
             kBorderSlack * tolerance &&
         ball_error(surface, (b.center + c.center) / 2, (b.radius + c.radius) / 2, reach) <= kBorderSlack * tolerance;
}

ExactBall ball_on_edge(const ClosestPoint& place) {
  ExactBall ball;
  ball.center = place.position;
  ball.contacts[0] = place;
  ball.contacts[0].distance = 0;
  ball.count = 1;
  ball.exact = true;
  ball.loss = std::numeric_limits<double>::infinity();
  return ball;
}

}  // namespace orchard::detail
