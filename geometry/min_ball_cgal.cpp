#include <CGAL/Exact_rational.h>
#include <CGAL/Min_sphere_of_spheres_d.h>

#include <cmath>
#include <vector>

#include "farthest_point.h"
#include "orchard/geometry/min_ball.h"

namespace orchard {
namespace {

// CGAL's version with doubles may return a ball that is too small. If it is too small by more than this, the cause is
// not just rounding.
constexpr double kBallRounding = 1e-12;

// Spheres of radius zero, as CGAL needs them.
template <class Number>
struct PointTraits {
  using FT = Number;
  using Sphere = std::array<Number, 3>;
  using Cartesian_const_iterator = const Number*;
  using Use_square_roots = CGAL::Tag_false;
  using Algorithm = CGAL::Farthest_first_heuristic;
  static constexpr int D = 3;
  static FT radius(const Sphere&) { return FT(0); }
  static Cartesian_const_iterator center_cartesian_begin(const Sphere& p) { return p.data(); }
};

template <class Number>
using MinSphere = CGAL::Min_sphere_of_spheres_d<PointTraits<Number>>;

Sphere ball_in_doubles(std::span<const Point> points) {
  std::vector<std::array<double, 3>> spheres;
  spheres.reserve(points.size());
  for (const Point& p : points) spheres.push_back({p.x(), p.y(), p.z()});
  MinSphere<double> min_sphere(spheres.begin(), spheres.end());
  const double* center = min_sphere.center_cartesian_begin();
  return {Point(center[0], center[1], center[2]), min_sphere.radius()};
}

// Returns the centre of the smallest ball around a few points, exact except for the final rounding. In exact
// arithmetic, CGAL returns each number as a pair (a, b), which means a + b * sqrt(discriminant). For spheres of radius
// 0, the root is rational or absent.
Point exact_center(const std::vector<Point>& points) {
  using Number = CGAL::Exact_rational;
  std::vector<std::array<Number, 3>> spheres;
  spheres.reserve(points.size());
  for (const Point& p : points) spheres.push_back({Number(p.x()), Number(p.y()), Number(p.z())});
  MinSphere<Number> min_sphere(spheres.begin(), spheres.end());
  const double root = std::sqrt(CGAL::to_double(min_sphere.discriminant()));
  Point center;
  auto coordinate = min_sphere.center_cartesian_begin();
  for (int axis = 0; axis < 3; ++axis, ++coordinate)
    center[axis] = CGAL::to_double(coordinate->first) + CGAL::to_double(coordinate->second) * root;
  return center;
}

// Extends a small set of points by the farthest point outside its smallest ball, until there is none.
Point center_of_active_set(std::span<const Point> points) {
  std::vector<Point> active{points[detail::farthest_from(points[0], points)]};
  active.push_back(points[detail::farthest_from(active[0], points)]);
  for (std::size_t round = 0; round < points.size(); ++round) {
    Point center = exact_center(active);
    const Point& farthest = points[detail::farthest_from(center, points)];
    if ((farthest - center).norm() <= radius_around(center, active) * (1 + kBallRounding)) return center;
    active.push_back(farthest);
  }
  return exact_center(active);
}

}  // namespace

Sphere minimal_ball(std::span<const Point> points) {
  if (points.empty()) return {};
  Sphere ball = ball_in_doubles(points);
  const double radius = radius_around(ball.center, points);
  if (!(radius <= ball.radius * (1 + kBallRounding))) ball.center = center_of_active_set(points);
  ball.radius = radius_around(ball.center, points);
  return ball;
}

}  // namespace orchard
