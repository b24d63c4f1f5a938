#include "orchard/medial/quality.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "quality/quality_parts.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr QualityOptions kFew{
    .surface_samples = 5000, .cells = 5000, .contact_cells = 500, .economy_candidates = 1000, .economy_samples = 2000};

MedialQuality quality_of(const test::KnownAxis& known) {
  return medial_quality(Surface(known.solid), known.axis, kFew);
}

TEST(MedialQuality, OfTheExactAxisOfABoxIsPerfect) {
  const MedialQuality quality = quality_of(test::known_box({1, 2, 3}));
  EXPECT_NEAR(quality.diagonal, std::sqrt(14.0), 1e-12);
  EXPECT_LT(quality.coverage.max, 1e-9);
  EXPECT_LT(quality.protrusion.max, 2e-6);
  EXPECT_LT(quality.radius_error.max, 1e-12);
  EXPECT_LT(quality.centredness.max, 2e-3);  // what the search is exact to
  EXPECT_EQ(quality.outside_edges, 0.0);
  EXPECT_EQ(quality.outside_triangles, 0.0);
  EXPECT_EQ(quality.found, quality.wanted);
  EXPECT_EQ(quality.found.euler_characteristic(), 1);
}

TEST(MedialQuality, OfTheBallOfASphereIsThatOfTheMesh) {
  const MedialQuality quality = quality_of(test::known_sphere(4));
  // The inscribed mesh lies below the ball by its sagitta, and the ball is as much too large.
  const double sagitta = 0.0023;
  EXPECT_EQ(quality.coverage.max, 0.0);
  EXPECT_LT(quality.protrusion.max, sagitta / quality.diagonal);
  EXPECT_GT(quality.protrusion.max, 0.2 * sagitta / quality.diagonal);
  EXPECT_LT(quality.radius_error.max, sagitta / quality.diagonal);
  EXPECT_LT(quality.centredness.max, 0.005);
  EXPECT_EQ(quality.found, quality.wanted);
  EXPECT_EQ(quality.economy.spheres, 1u);
  EXPECT_EQ(quality.economy.uncovered, 0.0);
}

TEST(MedialQuality, OfTheAxisOfACylinderIsNearlyPerfect) {
  const MedialQuality quality = quality_of(test::known_cylinder(64, 4));
  const double bulge = 1 / std::cos(std::numbers::pi / 64) - 1;  // of the prism beyond the cylinder
  EXPECT_LT(quality.coverage.max, 1.01 * bulge / quality.diagonal);
  EXPECT_LT(quality.protrusion.max, 1e-5);
  EXPECT_LT(quality.radius_error.max, 1e-12);
  EXPECT_LT(quality.centredness.max, 2e-3);
  EXPECT_EQ(quality.found, quality.wanted);
}

TEST(MedialQuality, OfTheCircleOfATorusHasItsLoop) {
  const MedialQuality quality = quality_of(test::known_torus(96, 48));
  EXPECT_LT(quality.coverage.max, 0.001);
  EXPECT_LT(quality.protrusion.max, 0.001);
  EXPECT_LT(quality.radius_error.max, 0.001);
  EXPECT_LT(quality.centredness.max, 0.01);
  EXPECT_EQ(quality.found.loops, 1);
  EXPECT_EQ(quality.found, quality.wanted);
}

TEST(MedialQuality, OfTheExactAxisOfAnLShapeIsPerfectUpToItsChords) {
  const MedialQuality quality = quality_of(test::known_l_shape(32));
  EXPECT_NEAR(quality.diagonal, std::sqrt(12.0), 1e-12);
  // Seen from the reentrant edge a chord of a parabola spans 1.4 degrees: its middle is nearer by 0.5 (1 - cos 0.7).
  const double chord = 4e-5;
  EXPECT_LT(quality.coverage.max, 1e-9);
  EXPECT_LT(quality.protrusion.max, chord);
  EXPECT_GT(quality.protrusion.max, 0);
  EXPECT_LT(quality.radius_error.max, 1e-12);  // vertices are on the parabola itself
  EXPECT_LT(quality.centredness.max, 2e-3);
  EXPECT_EQ(quality.outside_edges, 0.0);
  EXPECT_EQ(quality.outside_triangles, 0.0);
  EXPECT_EQ(quality.found, quality.wanted);
  EXPECT_EQ(quality.found, (Topology{.components = 1, .loops = 0, .cavities = 0}));
}

// Damage of a known size shows in the metric that stands for it, by that size.
TEST(MedialQuality, CoverageTellsHowFarAMissingSheetReached) {
  test::KnownAxis known = test::known_box({1, 2, 3});
  MedialMesh& axis = known.axis;
  axis = {};
  axis.centers = {{0.5, 1, 1.5}};
  axis.radii = {0.5};
  const MedialQuality quality = quality_of(known);
  // The corner is farthest from the one ball.
  const double farthest = std::sqrt(14.0) / 2 - 0.5;
  EXPECT_LE(quality.coverage.max * quality.diagonal, farthest);
  EXPECT_GT(quality.coverage.max * quality.diagonal, 0.9 * farthest);
}

TEST(MedialQuality, ProtrusionAndRadiusErrorTellHowMuchTooLargeBallsAre) {
  test::KnownAxis known = test::known_box({1, 2, 3});
  for (Index i = 0; i < 4; ++i) known.axis.radii[i] += 0.05;
  const MedialQuality quality = quality_of(known);
  EXPECT_NEAR(quality.protrusion.max * quality.diagonal, 0.05, 1e-4);
  EXPECT_NEAR(quality.radius_error.max * quality.diagonal, 0.05, 1e-9);
}

TEST(MedialQuality, CentrednessTellsOfABallBesideTheAxis) {
  test::KnownAxis known = test::known_box({1, 2, 3});
  known.axis = {};
  known.axis.centers = {{0.25, 1, 1.5}};
  known.axis.radii = {0.25};
  const MedialQuality quality = quality_of(known);
  // The nearest surface beyond the cone is where the cone meets the near side: 1 / cos 30 degrees.
  EXPECT_NEAR(quality.centredness.max, 1 / std::cos(std::numbers::pi / 6) - 1, 2e-3);
}

TEST(MedialQuality, OutsideCountsWhatLeavesTheSolid) {
  test::KnownAxis known = test::known_box({1, 2, 3});
  known.axis = {};
  known.axis.centers = {{0.5, 1, 1.5}, {0.5, 1, 4}, {0.5, 1, 9}};
  known.axis.radii = {0.5, 0.5, 0.5};
  known.axis.edges = {{0, 1}, {1, 2}};
  const MedialQuality quality = quality_of(known);
  EXPECT_NEAR(quality.outside_vertices, 2.0 / 3, 1e-12);
  EXPECT_NEAR(quality.outside_edges, 0.5, 1e-12);
  EXPECT_NEAR(quality.protrusion.max * quality.diagonal, 6.5, 1e-9);
}

TEST(MedialQuality, IsTheSameInAnyUnitAndOnAnyNumberOfThreads) {
  const test::KnownAxis known = test::known_torus(24, 12);
  const MedialQuality here = quality_of(known);
  test::KnownAxis large = known;
  large.solid = test::transformed(known.solid, 1024, Vector::Zero());
  for (Point& center : large.axis.centers) center *= 1024;
  for (double& radius : large.axis.radii) radius *= 1024;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const MedialQuality there = quality_of(large);
  EXPECT_EQ(here.coverage.mean, there.coverage.mean);
  EXPECT_EQ(here.protrusion.mean, there.protrusion.mean);
  EXPECT_EQ(here.centredness.mean, there.centredness.mean);
  EXPECT_EQ(here.economy.spheres, there.economy.spheres);
}

TEST(MedialQuality, RefusesWhatItCannotJudge) {
  const test::KnownAxis known = test::known_box({1, 2, 3});
  EXPECT_THROW(medial_quality(Surface(test::open_box()), known.axis, kFew), InputError);
  EXPECT_THROW(medial_quality(Surface(known.solid), {}, kFew), InputError);
}

TEST(SecondContact, IsTheFarSideOfASlab) {
  const Surface surface(test::box({0, 0, 0}, {1, 10, 10}));
  const double angle = std::numbers::pi / 6;
  EXPECT_NEAR(detail::second_contact_distance(surface, {0.5, 5, 5}, {-1, 0, 0}, angle, 0.01), 0.5, 1e-3);
  EXPECT_NEAR(detail::second_contact_distance(surface, {0.47, 5, 5}, {-1, 0, 0}, angle, 0.01), 0.53, 1e-3);
}

TEST(MedialStability, IsSmallForAThickPlateAndTheSameEveryTime) {
  const Surface surface(test::box({0, 0, 0}, {1, 2, 3}));
  const MedialBuildOptions options{.sampling = {.face_points = 1600, .edge_points = 400}};
  const MedialBuild build = build_medial_axis(surface, options);
  const std::optional<MedialStability> stability = medial_stability(surface, build, options);
  ASSERT_TRUE(stability);
  EXPECT_LT(stability->hausdorff, 2);
  EXPECT_LE(stability->percentile99, stability->hausdorff);
  EXPECT_LT(stability->mean, stability->percentile99);
  EXPECT_LT(stability->mean, 1);
  EXPECT_GT(stability->mean, 0.01);
  const std::optional<MedialStability> again = medial_stability(surface, build, options);
  EXPECT_EQ(stability->hausdorff, again->hausdorff);
  EXPECT_EQ(stability->mean, again->mean);
}

// A cylinder's axis is one long edge with nothing but its ends to show for it; with noise it is many short ones.
TEST(MedialStability, SeesLongCellsAndOnlyTheWidePartOfThem) {
  const Surface surface(test::known_cylinder(24, 3).solid);
  const MedialBuildOptions options{.sampling = {.face_points = 1600, .edge_points = 400}};
  const std::optional<MedialStability> stability =
      medial_stability(surface, build_medial_axis(surface, options), options);
  ASSERT_TRUE(stability);
  EXPECT_LT(stability->hausdorff, 3);
  EXPECT_LT(stability->percentile99, 1);
}

TEST(MedialRadiiAtSurface, AreHalfTheThickness) {
  TriangleMesh mesh = test::torus(48, 24);
  const test::KnownAxis known = test::known_torus(48, 24);
  for (const double radius : medial_radii_at_surface(Surface(mesh), known.axis)) EXPECT_NEAR(radius, 0.35, 1e-9);
}

}  // namespace
}  // namespace orchard
