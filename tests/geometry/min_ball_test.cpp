#include "orchard/geometry/min_ball.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard {
namespace {

struct NamedPoints {
  std::string name;
  std::vector<Point> points;
  double radius;  // of the minimal ball; 0 if not known
};

std::vector<NamedPoints> named_cases() {
  std::vector<NamedPoints> cases = {
      {"one", {{1, 2, 3}}, 0},
      {"coincident", std::vector<Point>(20, Point(0.1, 0.2, 0.3)), 0},
      {"pair", {{0, 0, 0}, {2, 0, 0}}, 1},
      {"collinear", {{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}}, 1.5 * std::sqrt(3.0)},
      {"obtuse triangle", {{-1, 0, 0}, {1, 0, 0}, {0, 0.1, 0}}, 1},
      {"equilateral triangle", {{1, 0, 0}, {-0.5, std::sqrt(0.75), 0}, {-0.5, -std::sqrt(0.75), 0}}, 1},
      {"cube corners", test::box({-1, -1, -1}, {1, 1, 1}).vertices, std::sqrt(3.0)},
      {"coplanar square", {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, std::sqrt(2.0)},
      {"cospherical", test::icosphere(3).vertices, 1},
      {"torus", test::torus(36, 18).vertices, 1.35},
      {"pin", {{0, 0, 0}, {1e-9, 0, 0}, {0, 0, 1}}, 0.5}};
  for (std::size_t i = cases.size(); i-- > 0;) {
    NamedPoints far = cases[i], small = cases[i];
    for (Point& p : far.points) p += Vector(1e6, -2e6, 3e6);
    for (Point& p : small.points) p *= 1e-6;
    far.name += " offset by 1e6", small.name += " scaled by 1e-6";
    small.radius *= 1e-6;
    cases.push_back(far);
    cases.push_back(small);
  }
  return cases;
}

double rounding(const std::vector<Point>& points) {
  double max = 0;
  for (const Point& p : points) max = std::max(max, p.cwiseAbs().maxCoeff());
  return 1e-15 * max;
}

void expect_inside(const std::vector<Point>& points, const Sphere& ball, const std::string& name) {
  for (const Point& p : points) EXPECT_LE((p - ball.center).norm(), ball.radius) << name;
}

// The smallest of all balls through two, three or four of the points that hold the others.
double radius_by_brute_force(const std::vector<Point>& points) {
  double best = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Point& center, double radius) {
    if (!(radius < best)) return;
    for (const Point& p : points)
      if ((p - center).norm() > radius * (1 + 1e-10)) return;
    best = radius;
  };
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      consider((points[i] + points[j]) / 2, (points[i] - points[j]).norm() / 2);
      for (std::size_t k = j + 1; k < n; ++k) {
        const Vector a = points[j] - points[i], b = points[k] - points[i], normal = a.cross(b);
        Eigen::Matrix3d rows;
        rows << a.transpose(), b.transpose(), normal.transpose();
        const Vector flat = rows.fullPivLu().solve(Vector(a.squaredNorm() / 2, b.squaredNorm() / 2, 0));
        consider(points[i] + flat, flat.norm());
        for (std::size_t l = k + 1; l < n; ++l) {
          const Vector c = points[l] - points[i];
          rows.row(2) = c.transpose();
          const Vector center = rows.fullPivLu().solve(Vector(a.squaredNorm(), b.squaredNorm(), c.squaredNorm()) / 2);
          consider(points[i] + center, center.norm());
        }
      }
    }
  return best;
}

TEST(RitterBall, HoldsEveryPoint) {
  for (const auto& [name, points, radius] : named_cases()) {
    const Sphere ball = ritter_ball(points);
    expect_inside(points, ball, name);
    EXPECT_LE(ball.radius, 1.3 * radius + rounding(points) + 1e-300) << name;
  }
}

TEST(RitterBall, IsLittleLargerThanMinimalOnRandomPoints) {
  double sum = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    std::vector<Point> points;
    Random random(seed, 1);
    for (int i = 0; i < 200; ++i) points.emplace_back(random.uniform(), random.uniform(), random.uniform());
    const Sphere ball = ritter_ball(points);
    expect_inside(points, ball, std::to_string(seed));
    sum += ball.radius / minimal_ball(points).radius;
  }
  EXPECT_LT(sum / 100, 1.15);
}

TEST(MinimalBall, HasTheKnownRadius) {
  for (const auto& [name, points, radius] : named_cases()) {
    const Sphere ball = minimal_ball(points);
    expect_inside(points, ball, name);
    EXPECT_NEAR(ball.radius, radius, 1e-11 * radius + rounding(points)) << name;
  }
}

TEST(MinimalBall, AgreesWithBruteForce) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Random random(seed, 2);
    std::vector<Point> points;
    for (std::uint64_t i = 0; i < 4 + seed % 9; ++i) {
      Point p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      if (seed % 3 == 1) p.z() *= 1e-6;
      if (seed % 3 == 2) p = (p.array() * 2).round();  // lattice points: cospherical, coplanar, coincident
      points.push_back(p);
    }
    const Sphere ball = minimal_ball(points);
    expect_inside(points, ball, std::to_string(seed));
    EXPECT_NEAR(ball.radius, radius_by_brute_force(points), 1e-9) << "seed " << seed;
  }
}

TEST(MinimalBall, IsNeverBeatenByRittersOrByMovingIt) {
  std::vector<NamedPoints> cases = named_cases();
  const std::filesystem::path folder = std::filesystem::path(ORCHARD_SHARED_MODELS) / "peer";
  for (const std::string name : {"lshape.obj", "lamp.obj", "torus.obj"})
    if (std::filesystem::exists(folder / name)) cases.push_back({name, read_mesh(folder / name).vertices, 0});
  for (const auto& [name, points, radius] : cases) {
    const Sphere ball = minimal_ball(points);
    expect_inside(points, ball, name);
    EXPECT_LE(ball.radius, ritter_ball(points).radius * (1 + 1e-12) + rounding(points)) << name;
    for (int axis = 0; axis < 6; ++axis) {
      Point moved = ball.center;
      moved[axis % 3] += (axis < 3 ? 1e-4 : -1e-4) * ball.radius;
      EXPECT_GE(radius_around(moved, points), ball.radius * (1 - 1e-12) - rounding(points)) << name;
    }
  }
}

TEST(BoundingBalls, OfNothingAreEmpty) {
  EXPECT_EQ(ritter_ball({}).radius, 0);
  EXPECT_EQ(minimal_ball({}).radius, 0);
  EXPECT_EQ(radius_around(Point(1, 1, 1), {}), 0);
}

TEST(BoundingBalls, ScaleExactlyByPowersOfTwo) {
  const std::vector<Point> points = test::l_shape().vertices;
  std::vector<Point> scaled;
  for (const Point& p : points) scaled.push_back(std::ldexp(1.0, -40) * p);
  for (const auto& ball_of : {ritter_ball, minimal_ball}) {
    const Sphere one = ball_of(points), other = ball_of(scaled);
    EXPECT_EQ(other.radius, std::ldexp(one.radius, -40));
    EXPECT_EQ(other.center, Point(std::ldexp(1.0, -40) * one.center));
  }
}

}  // namespace
}  // namespace orchard
