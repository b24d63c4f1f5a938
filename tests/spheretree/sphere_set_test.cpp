#include "orchard/spheretree/sphere_set.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>

#include "orchard/geometry/error.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

SphereSetBuild build(const Surface& surface, SphereFit fit, Index spheres) {
  return build_sphere_set(surface, {.fit = fit, .spheres = spheres, .effort = Effort::low});
}

TEST(SphereSet, CoversWithExactlyAsManyAsAskedFor) {
  const Surface surface(l_shape());
  for (const Index spheres : {1u, 2u, 7u}) {
    const SphereSetBuild set = build(surface, SphereFit::cover, spheres);
    EXPECT_EQ(set.spheres.size(), spheres);
    EXPECT_TRUE(set.kept);
    EXPECT_TRUE(set.audit.covered);
  }
}

TEST(SphereSet, LiesInsideAndFillsMoreWithMoreSpheres) {
  const Surface surface(l_shape());
  double left_out = surface.report().volume;
  for (const Index spheres : {1u, 6u}) {
    const SphereSetBuild set = build(surface, SphereFit::inside, spheres);
    EXPECT_EQ(set.spheres.size(), spheres);
    EXPECT_TRUE(set.kept);
    for (const Sphere& ball : set.spheres) EXPECT_LE(surface.signed_distance(ball.center) + ball.radius, 0);
    EXPECT_LT(set.audit.beside_solid->volume.uncovered.value, left_out);
    left_out = set.audit.beside_solid->volume.uncovered.value;
  }
}

TEST(SphereSet, FillsACubeWithItsInscribedBall) {
  const Surface cube(box(Point(0, 0, 0), Point(1, 1, 1)));
  const SphereSetBuild set = build(cube, SphereFit::inside, 1);
  EXPECT_NEAR(set.spheres[0].radius, 0.5, 0.01);
}

TEST(SphereSet, BalancedHasTheVolumeOfTheSolid) {
  const Surface surface(l_shape());
  const SphereSetBuild set = build(surface, SphereFit::balanced, 12);
  const UnionVolume& volume = set.audit.beside_solid->volume;
  EXPECT_TRUE(set.kept);
  EXPECT_NEAR(volume.balls.value, volume.solid, kBalancedVolume * volume.solid);
  EXPECT_NEAR(volume.outside.value, volume.uncovered.value, 2 * kBalancedVolume * volume.solid);
}

TEST(SphereSet, IsTheSameOnAnyNumberOfThreads) {
  const Surface surface(u_shape(0.5));
  for (const SphereFit fit : {SphereFit::cover, SphereFit::balanced}) {
    const SphereSetBuild usual = build(surface, fit, 4);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const SphereSetBuild alone = build(surface, fit, 4);
    for (std::size_t i = 0; i < usual.spheres.size(); ++i) {
      EXPECT_EQ(usual.spheres[i].center, alone.spheres[i].center);
      EXPECT_EQ(usual.spheres[i].radius, alone.spheres[i].radius);
    }
  }
}

TEST(SphereSet, TakesTheFewestSpheresForAnError) {
  const Surface surface(l_shape());
  SphereSetOptions options{.spheres = 6, .volume_error = 1.6, .effort = Effort::low};
  const SphereSetBuild enough = build_sphere_set(surface, options);
  EXPECT_TRUE(enough.error_reached);
  EXPECT_LE(enough.audit.beside_solid->volume.outside.value, 1.6 * surface.report().volume);
  EXPECT_LT(enough.spheres.size(), 6);
  options.volume_error = 1e-3;
  options.find_enough = false;
  const SphereSetBuild best = build_sphere_set(surface, options);
  EXPECT_FALSE(best.error_reached);
  EXPECT_FALSE(best.enough);
  EXPECT_EQ(best.spheres.size(), 6);
}

TEST(SphereSet, SaysHowManySpheresWouldDo) {
  const Surface surface(l_shape());
  SphereSetOptions options{.fit = SphereFit::inside, .spheres = 2, .volume_error = 0.3, .effort = Effort::low};
  const SphereSetBuild few = build_sphere_set(surface, options);
  EXPECT_FALSE(few.error_reached);
  ASSERT_TRUE(few.enough);
  options.spheres = *few.enough;
  EXPECT_TRUE(build_sphere_set(surface, options).error_reached);
  options.volume_error = 1e-6;
  EXPECT_FALSE(build_sphere_set(surface, options).enough);
}

TEST(SphereSet, HasNoSphereBelowTheSmallestRadius) {
  const Surface surface(l_shape());
  for (const SphereFit fit : {SphereFit::cover, SphereFit::inside, SphereFit::balanced}) {
    const SphereSetBuild set =
        build_sphere_set(surface, {.fit = fit, .spheres = 15, .min_radius = 0.3, .effort = Effort::low});
    EXPECT_EQ(set.spheres.size(), 15);
    EXPECT_TRUE(set.kept);
    EXPECT_GE(set.spheres.back().radius, 0.3);
  }
  // None so large lies in an arm of width 1.
  const SphereSetBuild none = build_sphere_set(
      surface,
      {.fit = SphereFit::inside, .spheres = 3, .min_radius = 0.8, .effort = Effort::low, .find_enough = false});
  EXPECT_FALSE(none.kept);
  EXPECT_EQ(none.spheres.size(), 3);
}

// How far the set sticks out, in the mean over its spheres with a centre where x is small or large.
std::array<double, 2> looseness_by_side(const Surface& surface, const SphereSetBuild& set, double border) {
  std::array<double, 2> sum{0, 0}, count{0, 0};
  for (const Sphere& ball : set.spheres) {
    const std::size_t side = ball.center.x() < border ? 0 : 1;
    sum[side] += surface.signed_distance(ball.center) + ball.radius;
    ++count[side];
  }
  return {sum[0] / count[0], sum[1] / count[1]};
}

TEST(SphereSet, IsTighterWhereItsLoosenessCountsMore) {
  const Surface surface(box(Point(0, 0, 0), Point(4, 1, 1)));
  const Box right(Point(2, 0, 0), Point(4, 1, 1));
  SphereSetOptions options{.spheres = 16, .effort = Effort::low};
  const std::array<double, 2> usual = looseness_by_side(surface, build_sphere_set(surface, options), 2);
  options.weights.regions = {{right, 8}};
  const SphereSetBuild weighted = build_sphere_set(surface, options);
  EXPECT_TRUE(weighted.kept);
  const std::array<double, 2> by_region = looseness_by_side(surface, weighted, 2);
  EXPECT_LT(by_region[1] / by_region[0], 0.8 * usual[1] / usual[0]);
  options.weights.regions.clear();
  for (const Point& vertex : surface.mesh().vertices) options.weights.of_vertices.push_back(vertex.x() > 2 ? 8 : 1);
  const std::array<double, 2> by_vertex = looseness_by_side(surface, build_sphere_set(surface, options), 2);
  EXPECT_LT(by_vertex[1] / by_vertex[0], 0.8 * usual[1] / usual[0]);
}

TEST(SphereSet, RefusesWhatIsOutOfRangeOrOfNoUse) {
  const Surface surface(l_shape());
  EXPECT_THROW(build_sphere_set(surface, {.spheres = 0}), InputError);
  EXPECT_THROW(build_sphere_set(surface, {.spheres = kMaxSetSpheres + 1}), InputError);
  EXPECT_THROW(build_sphere_set(surface, {.padding = -1}), InputError);
  EXPECT_THROW(build_sphere_set(surface, {.fit = SphereFit::inside, .padding = 1}), InputError);
  EXPECT_THROW(build_sphere_set(surface, {.fit = SphereFit::balanced, .solid = true}), InputError);
  EXPECT_THROW(build_sphere_set(Surface(open_box())), InputError);
  EXPECT_THROW(build_sphere_set(surface, {.weights = {.regions = {{Sphere{Point::Zero(), 1}, 0}}}}), InputError);
  EXPECT_THROW(build_sphere_set(surface, {.weights = {.of_vertices = {1, 1}}}), InputError);
}

// Balls along all edges and faces of a cube, and none in its middle.
std::vector<Sphere> hollow_cube() {
  std::vector<Sphere> balls;
  for (double x : {0.0, 0.5, 1.0})
    for (double y : {0.0, 0.5, 1.0})
      for (double z : {0.0, 0.5, 1.0})
        if (x != 0.5 || y != 0.5 || z != 0.5) balls.push_back({Point(x, y, z), 0.45});
  return balls;
}

TEST(CoversSolid, SeesAVoidThatNoPointOfTheSurfaceTellsOf) {
  const Surface cube(box(Point(0, 0, 0), Point(1, 1, 1)));
  std::vector<Sphere> balls = hollow_cube();
  EXPECT_FALSE(covers_solid(cube, balls));
  balls.push_back({Point(0.5, 0.5, 0.5), 0.08});
  EXPECT_FALSE(covers_solid(cube, balls));  // its corners are 0.0994 away
  balls.back().radius = 0.1;
  EXPECT_TRUE(covers_solid(cube, balls));
}

}  // namespace
}  // namespace orchard
