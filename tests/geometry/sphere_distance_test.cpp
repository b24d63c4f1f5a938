#include "orchard/geometry/sphere_distance.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard {
namespace {

Vector random_direction(Random& random) {
  Vector v;
  do v = Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  while (v.squaredNorm() > 1 || v.squaredNorm() < 1e-6);
  return v.normalized();
}

// From below, by many points of the sphere.
double densely_sampled(const Surface& surface, const Sphere& sphere, Random& random) {
  double max = 0;
  for (int i = 0; i < 5000; ++i)
    max = std::max(max, surface.signed_distance(sphere.center + sphere.radius * random_direction(random)));
  return max;
}

Sphere random_sphere(const Surface& surface, Random& random) {
  const double size = surface.bounding_radius();
  return {surface.bounding_ball().center + size * random.uniform() * random_direction(random),
          size * random.uniform(0.02, 0.9)};
}

TEST(SphereDistance, BracketsTheTruthOnSolidsThatAreNotConvex) {
  for (const TriangleMesh& mesh : {test::l_shape(), test::torus(24, 12), test::u_shape(0.4)}) {
    const Surface surface(mesh);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Random random(seed, 1);
      const Sphere sphere = random_sphere(surface, random);
      const double truth = densely_sampled(surface, sphere, random);
      const double slack = 1e-12 * surface.bounding_radius();
      EXPECT_GE(convex_sphere_distance(surface, sphere), truth - slack) << "seed " << seed;
      EXPECT_GE(corrected_sphere_distance(surface, sphere), truth - slack) << "seed " << seed;
      EXPECT_LE(sampled_sphere_distance(surface, sphere), truth + 0.06 * sphere.radius) << "seed " << seed;
      EXPECT_LE(sampled_sphere_distance(surface, sphere), convex_sphere_distance(surface, sphere) + slack);
      EXPECT_LE(corrected_sphere_distance(surface, sphere),
                sampled_sphere_distance(surface, sphere) + kDodecahedronGap * sphere.radius + slack);
    }
  }
}

TEST(SphereDistance, OfTheLemmaIsExactOnAConvexSolid) {
  const Surface surface(test::box(Point(-1, -2, -1), Point(1, 2, 1)));
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed, 2);
    const Sphere sphere = random_sphere(surface, random);
    const double lemma = convex_sphere_distance(surface, sphere);
    const double truth = densely_sampled(surface, sphere, random);
    EXPECT_LE(truth, lemma + 1e-12) << "seed " << seed;
    EXPECT_NEAR(truth, lemma, 0.02 * sphere.radius) << "seed " << seed;
  }
}

TEST(SphereDistance, OfTheLemmaOverestimatesWhereTheSolidIsNotConvex) {
  // A ball in the notch of an L: its farthest side faces another wall than the one nearest to its centre.
  const Surface surface(test::u_shape(0.4));
  double max_excess = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed, 3);
    const Sphere sphere = random_sphere(surface, random);
    max_excess =
        std::max(max_excess, convex_sphere_distance(surface, sphere) - densely_sampled(surface, sphere, random));
  }
  EXPECT_GT(max_excess, 0.1);
}

TEST(SphereDistance, OfTheSamplesIsExactWhereAVertexOfTheDodecahedronIsFarthest) {
  const Surface surface(test::box(Point(-1, -1, -1), Point(1, 1, 1)));
  // The cube's corner directions are vertices of the dodecahedron.
  const Sphere sphere{Point(3, 3, 3), 1};
  EXPECT_NEAR(sampled_sphere_distance(surface, sphere), std::sqrt(12.0) + 1, 1e-12);
}

TEST(SphereDistance, IsZeroInsideTheSolid) {
  const Surface surface(test::box(Point(-1, -1, -1), Point(1, 1, 1)));
  const Sphere sphere{Point::Zero(), 0.5};
  EXPECT_EQ(convex_sphere_distance(surface, sphere), 0);
  EXPECT_EQ(sampled_sphere_distance(surface, sphere), 0);
  EXPECT_LE(corrected_sphere_distance(surface, sphere), kDodecahedronGap * 0.5);
}

TEST(SphereDistance, RefusesASurfaceWithoutAnInside) {
  const Surface surface(test::open_box());
  EXPECT_THROW(convex_sphere_distance(surface, {Point::Zero(), 1}), InputError);
  EXPECT_THROW(sampled_sphere_distance(surface, {Point::Zero(), 1}), InputError);
  EXPECT_THROW(corrected_sphere_distance(surface, {Point::Zero(), 1}), InputError);
}

}  // namespace
}  // namespace orchard
