#include "orchard/covering/inaccuracy.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr double kTolerance = 1e-3;

Vector random_direction(Random& random) {
  Vector v;
  do v = Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  while (v.squaredNorm() > 1 || v.squaredNorm() < 1e-6);
  return v.normalized();
}

TEST(Inaccuracy, OfAConvexSolidIsTheSignedDistancePlusTheRadius) {
  // Lemma 5.1 is exact here, unless the farthest direction leaves the nearest face: stay near a face's middle.
  const Surface surface(test::box(Point(-1, -1, -1), Point(1, 1, 1)));
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed, 1);
    const Sphere sphere{Point(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(0.3, 0.9)),
                        random.uniform(0.2, 0.8)};
    const double truth = std::max(0.0, sphere.radius + surface.signed_distance(sphere.center));
    const Bounds bounds = inaccuracy(surface, sphere, {kTolerance, 0});
    EXPECT_LE(bounds.lower, truth + 1e-12) << "seed " << seed;
    EXPECT_GE(bounds.upper, truth - 1e-12) << "seed " << seed;
    EXPECT_LE(bounds.upper - bounds.lower, kTolerance * surface.bounding_radius() + 1e-12) << "seed " << seed;
  }
}

TEST(Inaccuracy, BracketsWhatDenseSamplingOfTheSphereFinds) {
  const std::vector<Surface> surfaces = [] {
    std::vector<Surface> list;
    list.emplace_back(test::l_shape());
    list.emplace_back(test::torus(24, 12));
    list.emplace_back(test::u_shape(0.4));
    return list;
  }();
  for (const Surface& surface : surfaces) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      Random random(seed, 2);
      const double size = surface.bounding_radius();
      const Sphere sphere{surface.bounding_ball().center + size * random.uniform() * random_direction(random),
                          size * random.uniform(0.02, 0.9)};
      const Bounds bounds = inaccuracy(surface, sphere, {kTolerance, 0});
      double sampled = 0;
      for (int i = 0; i < 4000; ++i)
        sampled = std::max(sampled, surface.signed_distance(sphere.center + sphere.radius * random_direction(random)));
      EXPECT_GE(bounds.upper, sampled * (1 - 1e-12)) << "seed " << seed;
      EXPECT_LE(bounds.lower, bounds.upper);
      EXPECT_LE(bounds.upper - bounds.lower, kTolerance * size + 1e-12) << "seed " << seed;
      EXPECT_NEAR(bounds.lower, sampled, 0.05 * sphere.radius + kTolerance * size) << "seed " << seed;
    }
  }
}

TEST(Inaccuracy, IsZeroForASphereInsideTheSolid) {
  const Surface surface(test::box(Point(-1, -1, -1), Point(1, 1, 1)));
  EXPECT_EQ(inaccuracy(surface, {Point::Zero(), 0.9}, {kTolerance, 0}).upper, 0);
}

// The signed distance is 0 on the faces between the cubes, which a search must not follow down: it took 200,000 places
// for each of these spheres.
TEST(Inaccuracy, IsZeroForASphereAcrossInteriorSurfaceInNoTime) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const int column = i % 2, row = i / 2 % 2, layer = i / 4;
    const Point at(column, row, layer);
    const auto first = static_cast<Index>(mesh.vertices.size());
    const TriangleMesh cube = test::box(at, at + Vector::Ones());
    mesh.vertices.insert(mesh.vertices.end(), cube.vertices.begin(), cube.vertices.end());
    for (const auto& [a, b, c] : cube.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  }
  const Surface surface(mesh);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 40; ++i) {
    const Sphere ball{Point(0.9 + 0.005 * i, 1.02, 0.6), 0.3};
    EXPECT_LE(inaccuracy(surface, ball, {1e-4, 0}).upper, 1e-4 * surface.bounding_radius());
    EXPECT_LE(farthest_from_solid(surface, ball, {1e-4, 0}).upper, 1e-4 * surface.bounding_radius());
  }
  const Sphere out{Point(1, 1, 1.9), 0.3};
  EXPECT_NEAR(inaccuracy(surface, out, {1e-4, 0}).upper, 0.2, 2e-4);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 15.0);
}

// A sliver's normal says little of where its plane is.
TEST(Inaccuracy, CountsWhatIsOutsideBesideASliver) {
  TriangleMesh mesh = test::box(Point(-1, -1, -1), Point(1, 1, 1));
  // Each side of one triangle in turn is divided a little outside its middle, and a sliver closes the gap to its
  // neighbour.
  const auto [a, b, c] = mesh.triangles[0];
  const std::array<Index, 3> corners{a, b, c};
  for (std::size_t i = 0; i < 3; ++i) {
    const Index from = corners[i], to = corners[(i + 1) % 3], other = corners[(i + 2) % 3];
    const auto middle = static_cast<Index>(mesh.vertices.size());
    TriangleMesh split = mesh;
    split.vertices.push_back((0.5 + 1e-10) * (mesh.vertices[from] + mesh.vertices[to]));
    split.triangles[0] = {from, middle, other};
    split.triangles.push_back({middle, to, other});
    split.triangles.push_back({from, to, middle});
    const Surface surface(split);
    ASSERT_TRUE(surface.solid());
    const Surface plain(mesh);
    const Sphere ball{0.9 * split.vertices.back(), 0.3};
    const double outside = farthest_from_solid(plain, ball, {1e-4, 0}).upper;
    EXPECT_GT(outside, 0.05);
    EXPECT_NEAR(farthest_from_solid(surface, ball, {1e-4, 0}).upper, outside, 1e-3);
    EXPECT_NEAR(inaccuracy(surface, ball, {1e-4, 0}).upper, inaccuracy(plain, ball, {1e-4, 0}).upper, 1e-3);
  }
}

TEST(Inaccuracy, ScalesWithTheModel) {
  const TriangleMesh mesh = test::torus(24, 12);
  const Sphere sphere{Point(0.7, 0.2, 0.1), 0.6};
  const Bounds at_one = inaccuracy(Surface(mesh), sphere, {kTolerance, 0});
  for (const double scale : {0x1p-20, 0x1p+20}) {
    const Surface scaled(test::transformed(mesh, scale, Vector::Zero()));
    const Bounds bounds = inaccuracy(scaled, {scale * sphere.center, scale * sphere.radius}, {kTolerance, 0});
    EXPECT_DOUBLE_EQ(bounds.lower, scale * at_one.lower);
    EXPECT_DOUBLE_EQ(bounds.upper, scale * at_one.upper);
  }
}

TEST(Inaccuracy, RefusesASurfaceWithoutAnInside) {
  const Surface surface(test::open_box());
  EXPECT_THROW(inaccuracy(surface, {Point::Zero(), 1}, {kTolerance, 0}), InputError);
}

TEST(FarthestFromSolid, BracketsWhatDenseSamplingOfTheBallFinds) {
  const Surface surface(test::u_shape(0.4));
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed, 4);
    const double size = surface.bounding_radius();
    const Sphere ball{surface.bounding_ball().center + size * random.uniform() * random_direction(random),
                      size * random.uniform(0.02, 0.9)};
    const Bounds bounds = farthest_from_solid(surface, ball, {kTolerance, 0});
    double sampled = 0;
    for (int i = 0; i < 4000; ++i) {
      const Point p = ball.center + ball.radius * std::cbrt(random.uniform()) * random_direction(random);
      sampled = std::max(sampled, surface.signed_distance(p));
    }
    EXPECT_GE(bounds.upper, sampled * (1 - 1e-12)) << "seed " << seed;
    EXPECT_LE(bounds.upper - bounds.lower, kTolerance * size + 1e-12) << "seed " << seed;
    EXPECT_NEAR(bounds.lower, sampled, 0.1 * ball.radius + kTolerance * size) << "seed " << seed;
    EXPECT_LE(bounds.upper, distance_bound(surface.signed_distance(ball.center), ball.radius)) << "seed " << seed;
    EXPECT_GE(bounds.upper, inaccuracy(surface, ball, {kTolerance, 0}).lower) << "seed " << seed;
  }
}

// The sphere around a hollow runs through the solid, so its inaccuracy is 0; its ball holds the hollow all the same.
TEST(FarthestFromSolid, CountsTheHollowThatABallFills) {
  TriangleMesh mesh = test::box(Point(-2, -2, -2), Point(2, 2, 2));
  const TriangleMesh hollow = test::mirrored(test::box(Point(-1, -1, -1), Point(1, 1, 1)));
  const auto base = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
  for (const auto& t : hollow.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  const Surface surface(mesh);
  ASSERT_TRUE(surface.solid());
  const Sphere ball{Point::Zero(), 1.8};
  EXPECT_EQ(inaccuracy(surface, ball, {kTolerance, 0}).upper, 0);
  const Bounds bounds = farthest_from_solid(surface, ball, {1e-4, 0});
  EXPECT_NEAR(bounds.lower, 1, 1e-3);
  EXPECT_GE(bounds.upper, 1);
}

TEST(FarthestFromSolid, KeepsTheToleranceAskedFor) {
  const Surface surface(test::u_shape(0.4));
  const double size = surface.bounding_radius();
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed, 5);
    const Sphere ball{surface.bounding_ball().center + size * random.uniform() * random_direction(random),
                      size * random.uniform(0.02, 0.9)};
    for (const Bounds& bounds : {farthest_from_solid(surface, ball), inaccuracy(surface, ball)}) {
      EXPECT_LE(bounds.upper - bounds.lower, std::max(1e-4 * size, 0.01 * bounds.lower) * (1 + 1e-9));
      EXPECT_GE(bounds.lower, 0);
    }
  }
}

TEST(FarthestFromSolid, TellsWhetherALimitHolds) {
  const Surface surface(test::torus(24, 12));
  const double size = surface.bounding_radius();
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed, 6);
    const Sphere ball{surface.bounding_ball().center + size * random.uniform() * random_direction(random),
                      size * random.uniform(0.02, 0.9)};
    const Bounds bounds = farthest_from_solid(surface, ball, {1e-4, 0});
    Point at;
    const double above = bounds.upper + 1e-3 * size, below = bounds.lower - 1e-3 * size;
    EXPECT_LE(farthest_against(surface, ball, above, at).upper, above) << "seed " << seed;
    if (below < 0) continue;
    EXPECT_GT(farthest_against(surface, ball, below, at).lower, below) << "seed " << seed;
    EXPECT_GT(surface.signed_distance(at), below) << "seed " << seed;
    EXPECT_LE((at - ball.center).norm(), ball.radius * (1 + 1e-12)) << "seed " << seed;
  }
}

TEST(DistanceBound, IsNeverBelowTheDistanceOfAPointOfTheBall) {
  const Surface surface(test::u_shape(0.4));
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed, 3);
    const Sphere ball{Point(random.uniform(-1, 4), random.uniform(-1, 3), random.uniform(-1, 2)),
                      random.uniform(0.01, 1)};
    const double bound = distance_bound(surface.signed_distance(ball.center), ball.radius);
    for (int i = 0; i < 50; ++i) {
      const Point p = ball.center + ball.radius * random.uniform() * random_direction(random);
      EXPECT_LE(std::max(0.0, surface.signed_distance(p)), bound) << "seed " << seed;
    }
  }
  EXPECT_EQ(distance_bound(-2, 1), 0);
}

}  // namespace
}  // namespace orchard
