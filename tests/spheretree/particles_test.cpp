#include "orchard/spheretree/particles.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numeric>

#include "orchard/geometry/error.h"
#include "orchard/spheretree/sphere_set.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

Surface cube() { return Surface(box(Point(0, 0, 0), Point(1, 1, 1))); }
Surface rod() { return Surface(box(Point(0, 0, 0), Point(10, 1, 1))); }

SphereSetBuild particles(const Surface& surface, Index spheres, const ParticleOptions& options, double min_radius = 0) {
  SphereSetOptions all{.fit = SphereFit::particles, .spheres = spheres};
  all.particles = options;
  all.min_radius = min_radius;
  all.effort = Effort::low;
  return build_sphere_set(surface, all);
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(OverlapShare, IsTheLensOfTheTextbook) {
  for (const double d : {0.25, 0.5, 1.0, 1.75}) {
    const double lens = (2 - d) * (2 - d) * (d + 4) / 16;  // of balls of radius 1
    EXPECT_NEAR(overlap_share({Point::Zero(), 1}, {Point(d, 0, 0), 1}), lens, 1e-14);
  }
  EXPECT_EQ(overlap_share({Point::Zero(), 1}, {Point(3, 0, 0), 1}), 0);
  EXPECT_EQ(overlap_share({Point::Zero(), 1}, {Point(0.5, 0, 0), 0.25}), 1);
  // Half of a ball that is small beside the other lies in it where the surface goes through its centre.
  EXPECT_NEAR(overlap_share({Point::Zero(), 1000}, {Point(1000, 0, 0), 0.1}), 0.5, 1e-4);
}

TEST(OverlapsAtMost, IsExactWhereBallsTouch) {
  // The doubles nearest to .1 and .6 are a little nearer to each other than .5, though their difference is rounded to
  // it.
  const Sphere a{Point(0.1, 0, 0), 0.25}, b{Point(0.6, 0, 0), 0.25};
  ASSERT_EQ(b.center.x() - a.center.x(), 0.5);
  EXPECT_FALSE(overlaps_at_most(a, b, 0));
  EXPECT_TRUE(overlaps_at_most({Point::Zero(), 0.5}, {Point(1, 0, 0), 0.5}, 0));
  EXPECT_FALSE(overlaps_at_most({Point::Zero(), 0.5}, {Point(std::nextafter(1.0, 0.0), 0, 0), 0.5}, 0));
}

TEST(OverlapsAtMost, CountsWhatIsTooNearToTheLimitAsAboveIt) {
  const Sphere a{Point::Zero(), 1};
  EXPECT_TRUE(overlaps_at_most(a, {Point(1 + 1e-12, 0, 0), 1}, 5.0 / 16));
  EXPECT_FALSE(overlaps_at_most(a, {Point(1 - 1e-12, 0, 0), 1}, 5.0 / 16));
  EXPECT_FALSE(overlaps_at_most(a, {Point(0.1, 0, 0), 0.2}, 0.99));
  EXPECT_TRUE(overlaps_at_most(a, {Point(0.1, 0, 0), 0.2}, 1));
}

TEST(Particles, InABallAreThatBall) {
  const Surface ball(icosphere(4));
  const SphereSetBuild set = particles(ball, 1, {.density = 3});
  EXPECT_TRUE(set.kept);
  EXPECT_NEAR(set.spheres[0].radius, 1, 0.01);
  const ParticleFigures& figures = *set.particles;
  EXPECT_NEAR(figures.body.volume, 3 * ball.report().volume, 1e-9);
  EXPECT_NEAR(figures.body.inertia(0, 0), 0.4 * figures.body.volume * std::pow(set.spheres[0].radius, 2), 1e-9);
}

TEST(Particles, OfARodAreARow) {
  const SphereSetBuild set = particles(rod(), 10, {.equal_radii = true});
  EXPECT_TRUE(set.kept);
  EXPECT_NEAR(set.spheres.back().radius, 0.5, 0.02);
  // Ten balls of radius 1/2 side by side against the rod: 0.97 % of the inertia by the textbook.
  EXPECT_NEAR(set.particles->inertia_error, 0.0097, 0.004);
}

// All pairs, independently of how the set was made.
void expect_apart(const SphereSetBuild& set, double share) {
  EXPECT_TRUE(set.particles->overlap_proven);
  for (std::size_t a = 0; a < set.spheres.size(); ++a)
    for (std::size_t b = a + 1; b < set.spheres.size(); ++b)
      EXPECT_LE(overlap_share(set.spheres[a], set.spheres[b]), share + 1e-12) << a << ' ' << b;
}

TEST(Particles, KeepApartAndLieInTheSolid) {
  const Surface surface(l_shape());
  for (const bool equal : {false, true}) {
    const SphereSetBuild set = particles(surface, 30, {.equal_radii = equal});
    EXPECT_EQ(set.spheres.size(), 30);
    EXPECT_TRUE(set.kept);
    expect_apart(set, 0);
    for (const Sphere& ball : set.spheres) EXPECT_LE(surface.signed_distance(ball.center) + ball.radius, 0);
    EXPECT_EQ(set.spheres.front().radius == set.spheres.back().radius, equal);
    EXPECT_LE(set.particles->inertia_error, ParticleOptions{}.inertia_error);
  }
}

TEST(Particles, AreLargerWhereTheyMayOverlap) {
  const SphereSetBuild apart = particles(cube(), 27, {.equal_radii = true});
  const SphereSetBuild overlapping = particles(cube(), 27, {.overlap = 0.2, .equal_radii = true});
  expect_apart(overlapping, 0.2);
  EXPECT_GT(overlapping.spheres[0].radius, 1.05 * apart.spheres[0].radius);
  EXPECT_GT(overlapping.particles->largest_overlap, 0.1);
  expect_apart(particles(cube(), 27, {.overlap = 0.2}), 0.2);
}

TEST(Particles, HaveTheMassOfTheSolidOrOfTheBalls) {
  using DensityOf = ParticleOptions::DensityOf;
  const SphereSetBuild of_solid = particles(cube(), 12, {.density = 7});
  EXPECT_NEAR(of_solid.particles->body.volume, 7, 1e-9);
  const SphereSetBuild of_balls = particles(cube(), 12, {.density_of = DensityOf::balls, .density = 7});
  EXPECT_NEAR(of_balls.particles->body.volume, 7 * of_balls.particles->filled, 1e-9);
  EXPECT_NEAR(of_balls.particles->masses[0] / std::pow(of_balls.spheres[0].radius, 3), 7 * 4.1887902047863905, 1e-9);
}

TEST(Particles, HaveMassesOfTheirOwnWithTheSolidsInertia) {
  const Surface surface(l_shape());
  const SphereSetBuild set =
      particles(surface, 25, {.density = 2, .own_masses = true, .center_error = 1e-7, .inertia_error = 1e-6});
  EXPECT_TRUE(set.kept);
  for (const double mass : set.particles->masses) EXPECT_GE(mass, 0);
  EXPECT_NEAR(sum(set.particles->masses), 2 * surface.report().volume, 1e-9);
  const MassProperties solid = mass_properties(surface);
  EXPECT_NEAR((set.particles->body.inertia - 2 * solid.inertia).norm(), 0, 1e-5 * solid.inertia.norm());
}

TEST(Particles, SayHowManyWouldDoWhereSoFewDoNot) {
  const SphereSetBuild one = particles(rod(), 1, {});
  EXPECT_FALSE(one.kept);
  EXPECT_GT(one.particles->inertia_error, 0.5);
  ASSERT_TRUE(one.enough);
  EXPECT_TRUE(particles(rod(), *one.enough, {}).kept);
}

TEST(Particles, SayHowManyWouldDoWhereSoManyAreTooSmall) {
  const SphereSetBuild many = particles(cube(), 200, {.inertia_error = 0.1}, 0.12);
  EXPECT_EQ(many.spheres.size(), 200);
  EXPECT_FALSE(many.kept);
  expect_apart(many, 0);
  ASSERT_TRUE(many.enough);
  EXPECT_LT(*many.enough, 200);
  const SphereSetBuild enough = particles(cube(), *many.enough, {.inertia_error = 0.1}, 0.12);
  EXPECT_TRUE(enough.kept);
  EXPECT_GE(enough.spheres.back().radius, 0.12);
}

TEST(Particles, AreTheSameOnAnyNumberOfThreads) {
  const Surface surface(u_shape(0.5));
  for (const bool equal : {false, true}) {
    const SphereSetBuild usual = particles(surface, 12, {.equal_radii = equal});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const SphereSetBuild alone = particles(surface, 12, {.equal_radii = equal});
    for (std::size_t i = 0; i < usual.spheres.size(); ++i) {
      EXPECT_EQ(usual.spheres[i].center, alone.spheres[i].center);
      EXPECT_EQ(usual.spheres[i].radius, alone.spheres[i].radius);
    }
  }
}

TEST(Particles, RefuseWhatIsOutOfRange) {
  EXPECT_THROW(particles(cube(), 5, {.overlap = 1.5}), InputError);
  EXPECT_THROW(particles(cube(), 5, {.density = 0}), InputError);
  EXPECT_THROW(particles(cube(), 5, {.inertia_error = std::nan("")}), InputError);
}

}  // namespace
}  // namespace orchard
