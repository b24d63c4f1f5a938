#include "orchard/geometry/min_ball.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "farthest_point.h"

namespace orchard {

double radius_around(const Point& center, std::span<const Point> points) {
  double max = 0;
  for (const Point& p : points) max = std::max(max, (p - center).squaredNorm());
  // A difference, three squares, two sums and a root each have an error of at most half a unit in the last place.
  return std::sqrt(max) * (1 + 4 * std::numeric_limits<double>::epsilon());
}

Sphere ritter_ball(std::span<const Point> points) {
  if (points.empty()) return {};
  const Point& first = points[detail::farthest_from(points[0], points)];
  const Point& second = points[detail::farthest_from(first, points)];
  Sphere ball{first + 0.5 * (second - first), 0.5 * (second - first).norm()};
  for (const Point& p : points) {
    const Vector offset = p - ball.center;
    const double distance = offset.norm();
    if (distance <= ball.radius) continue;
    const double radius = 0.5 * (ball.radius + distance);
    ball.center += ((distance - radius) / distance) * offset;
    ball.radius = radius;
  }
  ball.radius = radius_around(ball.center, points);
  return ball;
}

}  // namespace orchard
