#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "support/effort.h"
#include "surface_queries.h"

namespace orchard {
namespace {

using test::all_meshes;
using test::closest_by_brute_force;
using test::queries_for;

double rounding_at(const Surface& surface) {
  const Box& box = surface.bounding_box();
  return 1e-12 * (box.min().norm() + box.max().norm() + surface.bounding_radius());
}

std::array<Sphere, 3> balls_near(const Surface& surface, const Point& place, Random& random) {
  std::array<Sphere, 3> balls;
  const double size = surface.bounding_radius() * std::pow(10, random.uniform(-4, -0.3));
  const double distance = surface.distance(place);
  for (Sphere& ball : balls) {
    ball.center = place + size * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    ball.radius = distance + size * random.uniform(-0.5, 0.5);
  }
  return balls;
}

TEST(SurfaceReach, BoundsEveryInterpolatedBall) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + test::more(); ++seed) {
    for (const auto& [name, mesh] : all_meshes()) {
      const Surface surface(mesh);
      const double rounding = rounding_at(surface);
      std::uint64_t item = 0;
      for (const Point& place : queries_for(surface, 40, seed + 60)) {
        if ((place - surface.bounding_ball().center).norm() > 4 * surface.bounding_radius()) continue;
        Random random(seed, 61, item++);
        const std::array<Sphere, 3> balls = balls_near(surface, place, random);
        const Point middle = (balls[0].center + balls[1].center + balls[2].center) / 3;
        const double enough = surface.bounding_radius() * random.uniform(-0.2, 0.1);
        const double bound = surface.max_reach(balls, middle, enough);
        ASSERT_GE(bound, enough);
        for (int i = 0; i < 20; ++i) {
          const double u = random.uniform(), v = random.uniform() * (1 - u), w = 1 - u - v;
          const Point center = u * balls[0].center + v * balls[1].center + w * balls[2].center;
          const double radius = u * balls[0].radius + v * balls[1].radius + w * balls[2].radius;
          const double beyond = radius - closest_by_brute_force(surface, center).distance;
          ASSERT_LE(beyond, bound + rounding) << name << " at " << center.transpose() << ", seed " << seed;
        }
      }
    }
  }
}

TEST(SurfaceReach, IsExactOfOneBall) {
  for (const auto& [name, mesh] : all_meshes()) {
    const Surface surface(mesh);
    for (const Point& place : queries_for(surface, 40, 62)) {
      if ((place - surface.bounding_ball().center).norm() > 1.5 * surface.bounding_radius()) continue;
      const Sphere ball{place, 0.3 * surface.bounding_radius()};
      const double beyond = ball.radius - closest_by_brute_force(surface, place).distance;
      const double bound = surface.max_reach({ball, ball, ball}, place, -std::numeric_limits<double>::infinity());
      ASSERT_NEAR(bound, beyond, rounding_at(surface)) << name << " at " << place.transpose();
      ASSERT_EQ(surface.max_reach({ball, ball, ball}, place, bound + surface.bounding_radius()),
                bound + surface.bounding_radius());
    }
  }
}

TEST(SurfaceReach, IsUnknownOfBallsFarAway) {
  const Surface surface(all_meshes().front().mesh);
  const Point far = surface.bounding_ball().center + 100 * surface.bounding_radius() * Vector::UnitX();
  EXPECT_EQ(surface.max_reach({Sphere{far, 1}, Sphere{far, 1}, Sphere{far, 1}}, far, 0),
            std::numeric_limits<double>::infinity());
}

TEST(VisitNearest, LeavesOutNothingThatIsNearer) {
  for (const auto& [name, mesh] : all_meshes()) {
    const Surface surface(mesh);
    std::uint64_t item = 0;
    for (const Point& query : queries_for(surface, 40, 63)) {
      Random random(6, 64, item++);
      // The nearest of every other triangle: what is left out must be no nearer.
      const std::uint64_t wanted = random.below(2);
      const auto distance = [&](Index triangle) {
        const auto [a, b, c] = surface.corners(triangle);
        return closest_point_of_triangle(query, a, b, c).distance;
      };
      double nearest = std::numeric_limits<double>::infinity(), expected = nearest;
      surface.visit_nearest(query, [&](Index triangle) {
        if (triangle % 2 == wanted) nearest = std::min(nearest, distance(triangle));
        return nearest;
      });
      for (Index t = 0; t < mesh.triangles.size(); ++t)
        if (t % 2 == wanted) expected = std::min(expected, distance(t));
      ASSERT_EQ(nearest, expected) << name << " at " << query.transpose();
    }
  }
}

}  // namespace
}  // namespace orchard
