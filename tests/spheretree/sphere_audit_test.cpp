#include "orchard/spheretree/sphere_audit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "orchard/geometry/error.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

using std::numbers::pi;

Surface unit_cube() { return Surface(box(Point(-0.5, -0.5, -0.5), Point(0.5, 0.5, 0.5))); }

SphereAudit audit(const Surface& surface, const std::vector<Sphere>& balls) {
  return audit_spheres(surface, balls, {.rays = 8000, .surface_samples = 4000, .sphere_samples = 8000});
}

TEST(SphereAudit, ProvesThatABallAroundACubeLeavesNothingOpen) {
  const Surface cube = unit_cube();
  const double radius = std::sqrt(0.75) * (1 + 1e-9);
  const SphereAudit result = audit(cube, {{Point::Zero(), radius}});
  EXPECT_TRUE(result.covered);
  EXPECT_EQ(result.open_area.upper, 0);
  EXPECT_EQ(result.largest_gap.upper, 0);
  ASSERT_TRUE(result.beside_solid);
  const auto& beside = *result.beside_solid;
  EXPECT_LE(beside.protrusion.lower, radius - 0.5);
  EXPECT_GE(beside.protrusion.upper, radius - 0.5);
  EXPECT_NEAR(beside.protrusion.upper, beside.protrusion.lower, 0.01);
  EXPECT_NEAR(beside.volume.balls.value, ball_volume(radius), 0.003 * ball_volume(radius));
  EXPECT_NEAR(beside.volume.outside.value, ball_volume(radius) - 1, 0.005);
  EXPECT_NEAR(beside.volume.uncovered.value, 0, 1e-12);
  EXPECT_NEAR(inertia_difference(beside.volume.of_balls, beside.volume.of_solid, true), 0.4 * radius * radius * 6 - 1,
              0.01);
  EXPECT_NEAR(beside.mean.boundary_area, 4 * pi * radius * radius, 1e-9);
}

TEST(SphereAudit, BoundsTheOpenAreaAndTheGapOfABallOnAFace) {
  const Surface cube = unit_cube();
  const SphereAudit result = audit(cube, {{Point(0, 0, 0.5), 0.25}});
  EXPECT_FALSE(result.covered);
  EXPECT_TRUE(result.touches);
  const double open = 6 - pi / 16, gap = std::sqrt(1.5) - 0.25;
  EXPECT_LE(result.open_area.lower, open);
  EXPECT_GE(result.open_area.upper, open);
  EXPECT_NEAR(result.open_area.lower, result.open_area.upper, 0.003 * open);
  EXPECT_LE(result.largest_gap.lower, gap * (1 + 1e-12));
  EXPECT_GE(result.largest_gap.upper, gap * (1 - 1e-12));
  EXPECT_NEAR(result.gap_place.cwiseAbs().minCoeff(), 0.5, 1e-6);
  EXPECT_LT(result.gap_place.z(), 0);
  const auto& beside = *result.beside_solid;
  EXPECT_NEAR(beside.mean.outside_share, 0.5, 0.01);
  EXPECT_NEAR(beside.protrusion.upper, 0.25, 0.003);
  EXPECT_EQ(beside.protruding, 0);
}

TEST(SphereAudit, MeasuresTheDepthOfTheSurfaceInOverlappingBalls) {
  // Two balls of radius 1 at a distance of 1: the middle of their rim is sqrt(3)/2 from the nearest boundary.
  const std::vector<Sphere> balls{{Point(-0.5, 0, 0), 1}, {Point(0.5, 0, 0), 1}};
  const Surface speck(box(Point(-1e-3, -1e-3, -1e-3), Point(1e-3, 1e-3, 1e-3)));
  EXPECT_NEAR(audit(speck, balls).beside_solid->mean.surface_to_union, std::sqrt(0.75), 0.002);
}

TEST(SphereAudit, HasCurobosFiguresByItsDefinitions) {
  const Surface cube = unit_cube();
  // Half of the points of the first ball are outside; the second one, equal to it, counts again.
  const SphereAudit result = audit(cube, {{Point(0, 0, 0.5), 0.25}, {Point(0, 0, 0.5), 0.25}});
  const CuroboFigures& figures = result.beside_solid->curobo;
  EXPECT_EQ(figures.num_spheres, 2);
  EXPECT_NEAR(figures.protrusion, 0.5, 0.01);
  EXPECT_NEAR(figures.protrusion_dist_mean, 0.125, 0.003);
  EXPECT_NEAR(figures.protrusion_dist_p95, 0.95 * 0.25, 0.005);
  EXPECT_NEAR(figures.volume_ratio, 2 * ball_volume(0.25), 1e-9);
  EXPECT_NEAR(figures.coverage, ball_volume(0.25) / 2, 0.001);
  EXPECT_LE(figures.max_uncovered_gap, result.largest_gap.upper);
}

TEST(SphereAudit, OfAnOpenMeshHasTheSurfacesFiguresAlone) {
  const SphereAudit result = audit(Surface(open_box()), {{Point::Zero(), 10}});
  EXPECT_TRUE(result.covered);
  EXPECT_FALSE(result.beside_solid);
}

TEST(SphereAudit, RefusesNoSphereAndWhatIsNone) {
  const Surface cube = unit_cube();
  EXPECT_THROW(audit(cube, {}), InputError);
  EXPECT_THROW(audit(cube, {{Point::Zero(), 0}}), InputError);
  EXPECT_THROW(audit(cube, {{Point::Zero(), std::numeric_limits<double>::infinity()}}), InputError);
  EXPECT_THROW(audit(cube, {{Point(0, std::nan(""), 0), 1}}), InputError);
}

TEST(MassProperties, OfABoxAreThoseOfTheTextbook) {
  const MassProperties body = mass_properties(Surface(box(Point(1, 2, 3), Point(2, 4, 6))));
  EXPECT_NEAR(body.volume, 6, 1e-12);
  EXPECT_NEAR((body.center - Point(1.5, 3, 4.5)).norm(), 0, 1e-12);
  EXPECT_NEAR(body.inertia(0, 0), 6 * (4 + 9) / 12.0, 1e-11);
  EXPECT_NEAR(body.inertia(1, 1), 6 * (1 + 9) / 12.0, 1e-11);
  EXPECT_NEAR(body.inertia(0, 1), 0, 1e-11);
}

}  // namespace
}  // namespace orchard
