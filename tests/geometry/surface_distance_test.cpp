#include "orchard/geometry/surface_distance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard {
namespace {

TriangleMesh cube(double lower, double upper) { return test::box(Point::Constant(lower), Point::Constant(upper)); }

TriangleMesh random_triangles(std::uint64_t seed, int count) {
  Random random(seed, 7);
  TriangleMesh mesh;
  for (Index i = 0; i < static_cast<Index>(3 * count); ++i)
    mesh.vertices.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  for (Index i = 0; i < static_cast<Index>(3 * count); i += 3) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

TEST(SurfaceDistance, IsRightWhereTheAnswerIsKnown) {
  const double d = 0.25;
  const struct {
    const char* name;
    TriangleMesh from, to;
    double distance;
  } cases[] = {
      {"itself", test::l_shape(), test::l_shape(), 0},
      {"box in a larger one", cube(0, 1), cube(-d, 1 + d), d},
      {"box around a smaller one", cube(-d, 1 + d), cube(0, 1), d * std::sqrt(3.0)},
      {"moved box", cube(0, 1), test::transformed(cube(0, 1), 1, Vector(d, 0, 0)), d},
      {"without a lid", test::box(Point(0, 0, 0), Point(1, 1, 1)), test::open_box(), 0.5},
      {"only a lid more", test::open_box(), test::box(Point(0, 0, 0), Point(1, 1, 1)), 0},
      {"part far away", test::two_boxes(5), cube(0, 1), 6},
      {"plane over a point-like triangle",
       {{{-1, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}}},
       {{{0, 0, 0}, {1e-9, 0, 0}, {0, 1e-9, 0}}, {{0, 1, 2}}},
       std::sqrt(2.0)},
      {"far from the origin", test::transformed(cube(-d, 1 + d), 1, Vector(1e6, -1e6, 1e6)),
       test::transformed(cube(0, 1), 1, Vector(1e6, -1e6, 1e6)), d * std::sqrt(3.0)},
  };
  for (const auto& [name, from, to, distance] : cases) {
    const SurfaceDistanceOptions options{.tolerance = 1e-5};
    const Surface a(from), b(to);
    const SurfaceDistance found = surface_distance(a, b, options);
    EXPECT_LE(found.lower, distance + 2e-9) << name;
    EXPECT_GE(found.upper, distance - 2e-9) << name;
    EXPECT_LE(found.upper - found.lower, options.tolerance * b.bounding_radius() + 1e-6) << name;
    EXPECT_NEAR(b.distance(found.at), found.lower, 1e-6) << name;
    EXPECT_LT(a.distance(found.at), 1e-9) << name;
  }
}

TEST(SurfaceDistance, BoundsEverySampleOfRandomTriangles) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Surface from(random_triangles(seed, 6)), to(random_triangles(seed + 1000, 8));
    const SurfaceDistance found = surface_distance(from, to, {.tolerance = 1e-3});
    EXPECT_LE(found.upper - found.lower, 1.0001e-3 * to.bounding_radius()) << "seed " << seed;
    Random random(seed, 8);
    double max = 0;
    for (int i = 0; i < 3000; ++i) {
      const auto corners = from.corners(static_cast<Index>(random.below(6)));
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      max = std::max(max, to.distance(corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0])));
    }
    EXPECT_LE(max, found.upper) << "seed " << seed;
    EXPECT_NEAR(to.distance(found.at), found.lower, 1e-12) << "seed " << seed;
    EXPECT_LT(from.distance(found.at), 1e-12) << "seed " << seed;
  }
}

TEST(SurfaceDistance, IsStillABoundWhenTheBudgetRunsOut) {
  const Surface ball(test::icosphere(3)), around(test::icosphere(2, 2));
  const SurfaceDistance exact = surface_distance(around, ball, {.tolerance = 1e-4});
  double width = INFINITY;
  for (const Index budget : {1u, 300u, 1000u, 3000u}) {
    const SurfaceDistance rough = surface_distance(around, ball, {.tolerance = 1e-6, .max_evaluations = budget});
    EXPECT_LE(rough.lower, exact.upper);
    EXPECT_GE(rough.upper, exact.lower);
    EXPECT_LE(rough.upper - rough.lower, width);
    width = rough.upper - rough.lower;
  }
}

TEST(SurfaceDistance, ScalesExactlyByPowersOfTwo) {
  const TriangleMesh from = random_triangles(1, 6), to = random_triangles(2, 8);
  const SurfaceDistance found = surface_distance(Surface(from), Surface(to));
  for (const int exponent : {-300, -20, 1, 300}) {
    const double scale = std::ldexp(1.0, exponent);
    const SurfaceDistance scaled = surface_distance(Surface(test::transformed(from, scale, Vector::Zero())),
                                                    Surface(test::transformed(to, scale, Vector::Zero())));
    EXPECT_EQ(scaled.lower, scale * found.lower) << exponent;
    EXPECT_EQ(scaled.upper, scale * found.upper) << exponent;
  }
}

TEST(SurfaceDistance, StopsWhenAskedTo) {
  const Surface box_surface(cube(0, 1));
  EXPECT_THROW(surface_distance(box_surface, box_surface, {}, [](std::string_view, double) { return false; }),
               Cancelled);
}

}  // namespace
}  // namespace orchard
