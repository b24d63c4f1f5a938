// One instrument, each of its measures on the same few solids: hence more than 300 lines.
#include "orchard/medial/quality.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/axis_distance.h"
#include "quality/boundary_reach.h"
#include "quality/quality_parts.h"
#include "quality/smooth_noise.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr QualityOptions kFew{.surface_samples = 2000,
                              .cells = 2000,
                              .search = 20'000,
                              .contact_cells = 300,
                              .economy_candidates = 500,
                              .economy_samples = 1000};

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
  EXPECT_LT(quality.coverage.max, 1e-15);
  EXPECT_LT(quality.protrusion.max, sagitta / quality.diagonal);
  EXPECT_GT(quality.protrusion.max, 0.2 * sagitta / quality.diagonal);
  EXPECT_LT(quality.radius_error.max, sagitta / quality.diagonal);
  EXPECT_LT(quality.centredness.max, 0.005);
  EXPECT_EQ(quality.found, quality.wanted);
  EXPECT_EQ(quality.economy.spheres, 1u);
  EXPECT_EQ(quality.economy.uncovered, 0.0);
}

TEST(MedialQuality, OfTheAxisOfACylinderIsNearlyPerfect) {
  const MedialQuality quality = quality_of(test::known_cylinder(32, 4));
  const double bulge = 1 / std::cos(std::numbers::pi / 32) - 1;  // of the prism beyond the cylinder
  EXPECT_LT(quality.coverage.max, 1.01 * bulge / quality.diagonal);
  EXPECT_LT(quality.protrusion.max, 1e-5);
  EXPECT_LT(quality.radius_error.max, 1e-12);
  EXPECT_LT(quality.centredness.max, 2e-3);
  EXPECT_EQ(quality.found, quality.wanted);
}

// One ball in a box: what is farthest is a corner, which no random point is.
TEST(MedialQuality, FindsTheLargestCoverageErrorWhereNoSampleIs) {
  const test::KnownAxis box = test::known_box({1, 2, 3});
  const Point center = Surface(box.solid).bounding_box().center();
  MedialMesh ball{.centers = {center}, .radii = {0.5}, .edges = {}, .triangles = {}};
  const MedialQuality quality = medial_quality(Surface(box.solid), ball, kFew);
  const double exact = (std::sqrt(14.0) / 2 - 0.5) / quality.diagonal;
  EXPECT_NEAR(quality.coverage.max, exact, 1e-12);
  EXPECT_GE(quality.coverage_upper, exact - 1e-12);
  EXPECT_LT(quality.coverage_upper, exact + 1.1e-5);
  EXPECT_GE(quality.hausdorff.max, exact - 1e-12);
  EXPECT_TRUE(std::isnan(quality.inner_coverage.max)) << "the only ball is a border";
  EXPECT_TRUE(std::isnan(quality.inner_coverage.mean));
}

// Two balls on a line, and all between them: outside of the middle of a side, the nearest ball is at no border.
TEST(MedialQuality, TellsCoverageErrorsAtBordersFromThoseWithin) {
  const test::KnownAxis box = test::known_box({1, 2, 3});
  const Point center = Surface(box.solid).bounding_box().center();
  const Vector half(0, 0, 1.25);
  const MedialMesh curve{
      .centers = {center - half, center + half}, .radii = {0.25, 0.25}, .edges = {{0, 1}}, .triangles = {}};
  const MedialQuality quality = medial_quality(Surface(box.solid), curve, kFew);
  EXPECT_NEAR(quality.inner_coverage.max, (std::sqrt(1.25) - 0.25) / quality.diagonal, 0.01);
  EXPECT_LE(quality.inner_coverage.max, (std::sqrt(1.25) - 0.25) / quality.diagonal);
  EXPECT_NEAR(quality.coverage.max, (std::sqrt(1.25 + 0.0625) - 0.25) / quality.diagonal, 1e-12);
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
  const MedialQuality quality = quality_of(test::known_l_shape(8));
  EXPECT_NEAR(quality.diagonal, std::sqrt(12.0), 1e-12);
  // Seen from the reentrant edge a chord of a parabola spans 5.6 degrees: its middle is nearer by 0.5 (1 - cos 2.8).
  const double chord = 6e-4;
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
  for (const double likely : {0.1, 0.51, 0.6, std::numeric_limits<double>::infinity()}) {
    EXPECT_NEAR(detail::second_contact_distance(surface, {0.5, 5, 5}, {-1, 0, 0}, angle, likely), 0.5, 1e-3);
    EXPECT_NEAR(detail::second_contact_distance(surface, {0.47, 5, 5}, {-1, 0, 0}, angle, likely), 0.53, 1e-3);
  }
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

// The same solid from the same points, in 12 triangles and in 3072: the noise must not know.
TEST(MedialStability, IsTheSolidsHoweverFineItsTriangles) {
  const TriangleMesh coarse = test::box({0, 0, 0}, {1, 2, 3});
  const Surface surface(coarse), fine(detail::with_short_edges(coarse, 0.25));
  ASSERT_GT(fine.mesh().triangles.size(), 1000u);
  const MedialBuildOptions options{.sampling = {.face_points = 1600, .edge_points = 400}};
  const MedialBuild build = build_medial_axis(surface, options);
  SurfaceSampling points = build.sampling;
  for (Index i = 0; i < points.size(); ++i) {
    const ClosestPoint closest = fine.closest(points.points[i]);
    points.triangles[i] = closest.triangle;
    points.features[i] = closest.feature;
  }
  MedialBuildInput input;
  input.sampling = points;
  const MedialBuild fine_build = build_medial_axis(fine, options, {}, std::move(input));
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto few = medial_stability(surface, build, options, {.seed = seed});
    const auto many = medial_stability(fine, fine_build, options, {.seed = seed});
    ASSERT_TRUE(few && many);
    EXPECT_NEAR(few->mean, many->mean, 0.05 * many->mean);
    EXPECT_NEAR(few->percentile99, many->percentile99, 0.1 * many->percentile99);
    EXPECT_NEAR(few->hausdorff, many->hausdorff, 0.25 * many->hausdorff);
  }
}

TEST(MedialStability, IsTheSameInAnyUnitAndNeedsACorrelation) {
  const TriangleMesh mesh = test::torus(24, 12);
  const MedialBuildOptions options{.sampling = {.face_points = 800, .edge_points = 0}};
  const auto stability_of = [&](double scale) {
    const Surface surface(test::transformed(mesh, scale, Vector::Zero()));
    return medial_stability(surface, build_medial_axis(surface, options), options, {.seed = 7});
  };
  const auto here = stability_of(1), there = stability_of(1024);
  ASSERT_TRUE(here && there);
  EXPECT_EQ(here->hausdorff, there->hausdorff);
  EXPECT_EQ(here->percentile99, there->percentile99);
  EXPECT_EQ(here->mean, there->mean);
  const Surface surface(mesh);
  EXPECT_THROW(medial_stability(surface, build_medial_axis(surface, options), options, {.correlation = 0}), InputError);
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

// One ball of a cube's, with half the cube's inner radius: the envelope is short of the surface everywhere.
TEST(MedialQuality, HausdorffSeesWhatIsShortAndWhatIsTooLarge) {
  const Surface cube(test::box({0, 0, 0}, {2, 2, 2}));
  MedialMesh ball{.centers = {{1, 1, 1}}, .radii = {0.5}, .edges = {}, .triangles = {}};
  MedialQuality quality = medial_quality(cube, ball, kFew);
  const double diagonal = std::sqrt(12.0);
  EXPECT_NEAR(quality.hausdorff.max * diagonal, std::sqrt(3.0) - 0.5, 0.1);  // a corner; samples come near it
  EXPECT_LE(quality.hausdorff.max * diagonal, std::sqrt(3.0) - 0.5);
  EXPECT_DOUBLE_EQ(quality.hausdorff.max, quality.coverage.max);
  EXPECT_EQ(quality.protrusion.max, 0.0);
  ASSERT_EQ(quality.worst.size(), 5u);  // five of eight corners; nothing protrudes
  for (const WorstPlace& place : quality.worst) EXPECT_EQ(place.kind, WorstKind::coverage);

  ball.radii = {2.0};
  quality = medial_quality(cube, ball, kFew);
  EXPECT_NEAR(quality.hausdorff.max * diagonal, 1, 1e-9);  // beyond the middles of the faces
  EXPECT_EQ(quality.coverage.max, 0.0);
  EXPECT_NEAR(quality.worst.front().value * diagonal, 1, 1e-9);
  EXPECT_NEAR((quality.worst.front().position - Point(1, 1, 1)).norm(), 2, 1e-6);
  EXPECT_NEAR(quality.worst.front().outward.cwiseAbs().maxCoeff(), 1, 1e-9);
}

TEST(MedialQuality, WorstPlacesAreApartAndFromTheWorstDown) {
  std::vector<WorstPlace> places;
  for (int i = 0; i < 100; ++i)
    places.push_back({.kind = WorstKind::coverage, .value = (i * 37) % 100 / 100.0, .position = {0.01 * i, 0, 0}});
  const auto worst = detail::worst_of(places, 4, 0.1);
  ASSERT_EQ(worst.size(), 4u);
  EXPECT_EQ(worst[0].value, 0.99);
  for (std::size_t i = 0; i < worst.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE((worst[i].position - worst[j].position).norm(), 0.1);
    if (i > 0) {
      EXPECT_LT(worst[i].value, worst[i - 1].value);
    }
  }
}

TEST(MedialQuality, CountsSheetsCurvesAndFlakes) {
  MedialMesh mesh;
  mesh.centers = {{0, 0, 0},      {9, 0, 0},    {0, 9, 0}, {9, 9, 0}, {-9, 0, 0},
                  {-9.1, 0.1, 0}, {-9.1, 0, 0}, {0, 0, 9}, {5, 5, 5}};
  mesh.radii.assign(9, 1.0);
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}, {4, 5, 6}};
  mesh.edges = {{0, 4}, {0, 7}};
  complete(mesh);
  const MedialPieces pieces = medial_pieces(mesh);
  EXPECT_EQ(pieces.face_components, 2u);
  EXPECT_EQ(pieces.curve_components, 2u);  // two edges at one vertex, and the ball that is alone
  EXPECT_EQ(pieces.small, 2u);             // the small triangle and that ball
  const double flake = 0.1 + 0.1 + std::sqrt(0.02);
  EXPECT_NEAR(border_length(mesh), 4 * 9 + flake, 1e-9);
  MedialMesh ball{.centers = {{0, 0, 0}}, .radii = {1}, .edges = {}, .triangles = {}};
  EXPECT_EQ(medial_pieces(ball).small, 0u);  // alone
}

TEST(MedialQuality, ErrorsOfBallsAndPlacesAreThoseOfTheMetrics) {
  const test::KnownAxis known = test::known_box({1, 2, 3});
  const Surface surface(known.solid);
  MedialMesh axis = known.axis;
  axis.radii[3] += 0.07;
  std::vector<Sphere> balls;
  for (Index i = 0; i < axis.size(); ++i) balls.push_back({axis.centers[i], axis.radii[i]});
  const MedialQuality quality = medial_quality(surface, axis, kFew);
  const BallErrors errors = ball_errors(surface, balls);
  EXPECT_DOUBLE_EQ(*std::max_element(errors.radius_error.begin(), errors.radius_error.end()), quality.radius_error.max);
  EXPECT_NEAR(errors.radius_error[3] * quality.diagonal, 0.07, 1e-12);
  EXPECT_NEAR(errors.protrusion[3] * quality.diagonal, 0.07, 1e-12);
  EXPECT_EQ(errors.protrusion[2], 0.0);
  EXPECT_DOUBLE_EQ(*std::max_element(errors.centredness.begin(), errors.centredness.end()), quality.centredness.max);

  // Beside the middle of a face the reconstruction is exact; beside a corner without its ball it is not.
  const std::vector<Point> points{{0.5, 1, 0}, {0.5, 1, 3}};
  const std::vector<Vector> normals{{0, 0, -1}, {0, 0, 1}};
  const MedialMesh one{.centers = {{0.5, 1, 0.5}}, .radii = {0.5}, .edges = {}, .triangles = {}};
  const SurfaceErrors places = surface_errors(surface, one, points, normals);
  EXPECT_NEAR(places.coverage[0], 0, 1e-12);
  EXPECT_NEAR(places.coverage[1] * quality.diagonal, 2, 1e-9);
  EXPECT_EQ(places.protrusion[1], 0.0);
  EXPECT_THROW(ball_errors(Surface(test::open_box()), balls), InputError);
}

// Sheets that end in balls of radius 0 have such balls on the surface itself, where samples may be.
TEST(MedialQuality, PlacesAtBallsOfRadiusZeroAreNotOff) {
  const Surface cube(test::box({0, 0, 0}, {1, 1, 1}));
  const MedialMesh axis{
      .centers = {{0.5, 0.5, 0.5}, {0.1, 0.2, 1 + 1e-17}}, .radii = {0.5, 0}, .edges = {{0, 1}}, .triangles = {}};
  const std::vector<Point> points(50, axis.centers[1]);
  const SurfaceErrors errors = surface_errors(cube, axis, points, std::vector<Vector>(50, Vector(0, 0, 1)));
  for (const double coverage : errors.coverage) EXPECT_LT(coverage, 1e-8);
}

MedialMesh square(double z, double size) {
  MedialMesh mesh;
  mesh.centers = {{0, 0, z}, {size, 0, z}, {size, size, z}, {0, size, z}};
  mesh.radii.assign(4, 0.1);
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  complete(mesh);
  return mesh;
}

constexpr Index kSearch = 1'000'000;

// A sheet and a curve in a box, most of whose balls end before the surface, and some beyond it.
MedialMesh random_mesh(Random& random) {
  MedialMesh mesh;
  for (int v = 0; v < 5; ++v) {
    mesh.centers.emplace_back(random.uniform(0.1, 0.9), random.uniform(0.1, 1.9), random.uniform(0.1, 2.9));
    mesh.radii.push_back(random.uniform(0, 0.6));
  }
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}};
  mesh.edges = {{3, 4}};
  complete(mesh);
  return mesh;
}

// Any ball of the mesh.
Sphere random_ball(const MedialMesh& mesh, Random& random) {
  const auto cell = random.below(3);
  std::array<Index, 3> corners{3, 4, 4};
  if (cell < 2) corners = mesh.triangles[cell];
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const std::array<double, 3> weights{1 - u - v, u, v};
  Sphere ball{Point::Zero(), 0};
  for (std::size_t k = 0; k < 3; ++k) {
    ball.center += weights[k] * mesh.centers[corners[k]];
    ball.radius += weights[k] * mesh.radii[corners[k]];
  }
  return ball;
}

TEST(MedialQuality, NoPlaceOfTheBoundaryIsDeeperInTheSolidThanIsProven) {
  const Surface box(test::known_box({1, 2, 3}).solid);
  constexpr double kAccuracy = 0.01;
  for (std::uint64_t seed = test::first_seed(), end = seed + 20 * test::more(); seed < end; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 7);
    const MedialMesh mesh = random_mesh(random);
    const detail::Reconstruction reconstruction(mesh);
    const detail::SearchedMax dent = detail::max_dent(box, reconstruction, 0, kAccuracy, kSearch);
    double attained = 0;
    for (int i = 0; i < 4000; ++i) {
      const Sphere ball = random_ball(mesh, random);
      const Vector way(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Point place = ball.center + ball.radius * way.normalized();
      if (reconstruction.distance(place) > -1e-9) attained = std::max(attained, -box.signed_distance(place));
    }
    EXPECT_LE(attained, dent.upper);
    EXPECT_LE(dent.max, dent.upper);
    EXPECT_LE(dent.upper, dent.max + std::max(kAccuracy, 0.02 * dent.max) + 1e-9);
    if (!(dent.max > 0)) continue;
    EXPECT_NEAR(-box.signed_distance(dent.place), dent.max, 1e-12);
    EXPECT_NEAR(reconstruction.distance(dent.place), 0, 1e-9);
  }
}

TEST(MedialQuality, NoBallReachesFartherOutThanIsProven) {
  const Surface box(test::known_box({1, 2, 3}).solid);
  const Surface bend(test::known_l_shape(8).solid);
  constexpr double kAccuracy = 1e-3;
  for (std::uint64_t seed = test::first_seed(), end = seed + 20 * test::more(); seed < end; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 8);
    const MedialMesh mesh = random_mesh(random);
    for (const Surface* solid : {&box, &bend}) {
      const detail::QualityBalls balls = detail::quality_balls(mesh, kSearch);
      const std::vector<detail::BallDepth> depths = detail::depths_of(*solid, balls.all);
      const auto of_vertices = std::span(depths).first(balls.vertices),
                 of_triangles = std::span(depths).subspan(balls.vertices + balls.edges);
      const detail::SearchedMax most =
          detail::max_protrusion(*solid, mesh, {of_vertices, of_triangles}, 0, kAccuracy, kSearch);
      const detail::SearchedMax first = detail::max_protrusion(*solid, mesh, {{}, of_triangles}, 0, kAccuracy, kSearch);
      const detail::SearchedMax same = detail::max_protrusion(*solid, mesh, {}, 0, kAccuracy, kSearch);
      EXPECT_EQ(std::pair(first.max, first.upper), std::pair(same.max, same.upper));
      double bound = 0, attained = 0;
      for (int i = 0; i < 4000; ++i) {
        const Sphere ball = random_ball(mesh, random);
        bound = std::max(bound, ball.radius + solid->signed_distance(ball.center));
        attained = std::max(attained, detail::reach_of(*solid, ball, detail::depth_of(*solid, ball)).beyond);
      }
      EXPECT_LE(bound, most.upper);
      EXPECT_GE(most.max, attained - std::max(kAccuracy, 0.02 * most.max));
      if (most.max > 0) {
        EXPECT_NEAR(solid->signed_distance(most.place), most.max, 1e-12);
      }
      if (solid == &box) {  // beside a flat or convex surface, what is proven is what is attained
        EXPECT_LE(most.upper, most.max + std::max(kAccuracy, 0.02 * most.max) + 1e-9);
      }
    }
  }
}

TEST(MedialQuality, WorstProtrusionsAreTheSameAsWhereAllBallsAreLookedAt) {
  const Surface bend(test::known_l_shape(8).solid);
  constexpr double kNegligible = 1e-9;
  for (std::uint64_t seed = test::first_seed(), end = seed + 20 * test::more(); seed < end; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 9);
    const MedialMesh mesh = random_mesh(random);
    std::vector<Sphere> balls;
    const int count = 1 + static_cast<int>(2000 * random.uniform());
    for (int i = 0; i < count; ++i) balls.push_back(random_ball(mesh, random));
    const std::vector<WorstPlace> known{
        {WorstKind::protrusion, 0.1 * random.uniform(), balls[0].center, Vector::Zero(), balls[0]}};
    const std::vector<detail::BallDepth> depths = detail::depths_of(bend, balls);
    std::vector<WorstPlace> all = known;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const detail::BallReach reach = detail::reach_of(bend, balls[i], depths[i]);
      if (reach.beyond > kNegligible)
        all.push_back({WorstKind::protrusion, reach.beyond, reach.farthest, Vector::Zero(), balls[i]});
    }
    const double apart = 0.5 * random.uniform();
    for (const Index wanted : {0u, 1u, 5u, 50u}) {
      const auto right = detail::worst_of(all, wanted, apart);
      const auto found = detail::worst_protrusions(bend, balls, depths, known, wanted, apart, kNegligible);
      ASSERT_EQ(found.size(), right.size());
      for (std::size_t i = 0; i < right.size(); ++i) {
        EXPECT_EQ(found[i].value, right[i].value);
        EXPECT_EQ(found[i].position, right[i].position);
      }
    }
  }
}

// Two halves of a plate's sheet, apart: the boundary is deepest at the ends of the slit between them, half way to the
// plate's side.
TEST(MedialQuality, HausdorffSeesHowDeepASlitIs) {
  const Surface plate(test::known_box({1, 4, 4}).solid);
  constexpr double kHalfWidth = 0.48;
  const auto at = [](double y, double z) { return Point(0.5, y, z); };
  const double low = 2 - kHalfWidth, high = 2 + kHalfWidth;
  MedialMesh halves{.centers = {at(0.5, 0.5), at(low, 0.5), at(low, 3.5), at(0.5, 3.5),  //
                                at(high, 0.5), at(3.5, 0.5), at(3.5, 3.5), at(high, 3.5)},
                    .radii = std::vector<double>(8, 0.5),
                    .edges = {},
                    .triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
  complete(halves);
  const double exact = 0.5 - std::sqrt((0.25 - kHalfWidth * kHalfWidth) / 2);
  const detail::SearchedMax dent = detail::max_dent(plate, detail::Reconstruction(halves), 0, 1e-3, kSearch);
  EXPECT_LE(dent.max, exact + 1e-9);
  EXPECT_GE(dent.max, exact - 0.02 * exact);
  EXPECT_GE(dent.upper, exact);
  const MedialQuality quality = medial_quality(plate, halves, kFew);
  EXPECT_GE(quality.dent_upper, exact / quality.diagonal);
  EXPECT_GE(quality.hausdorff.max, 0.98 * dent.max / quality.diagonal);
  const WorstPlace& bottom = quality.worst.back();  // what is farthest off has a place
  EXPECT_EQ(bottom.kind, WorstKind::dent);
  EXPECT_NEAR(bottom.value, quality.hausdorff.max, 0.02 * bottom.value);
  EXPECT_NEAR(-plate.signed_distance(bottom.position), bottom.value * quality.diagonal, 1e-9);
  EXPECT_NEAR(bottom.position.y(), 2, 0.1);
}

TEST(AxisDistance, IsThatOfSheetsNotOfVertices) {
  const AxisDistance same = axis_distance(square(0, 1), square(0, 1), 1e-4);
  EXPECT_LT(same.max, 1e-15);
  EXPECT_LT(same.max_gap, 1e-4);
  EXPECT_LT(same.mean, 1e-15);
  const AxisDistance apart = axis_distance(square(0, 1), square(0.25, 1), 1e-4);
  EXPECT_DOUBLE_EQ(apart.max, 0.25);
  EXPECT_LT(apart.max_gap, 1e-4);
  EXPECT_DOUBLE_EQ(apart.mean, 0.25);
  // Every vertex of the frame is on the square, which reaches half its side from the frame, in its middle.
  MedialMesh frame = square(0, 1);
  frame.triangles.clear();
  frame.edges = {{0, 1}, {1, 2}, {2, 3}, {0, 3}};
  const AxisDistance hole = axis_distance(square(0, 1), frame, 1e-4);
  EXPECT_NEAR(hole.max, 0.5, 1e-4);
  EXPECT_LE(hole.max, 0.5);
  EXPECT_GE(hole.max + hole.max_gap, 0.5);
  EXPECT_EQ(hole.max_to, 0.0);
  EXPECT_DOUBLE_EQ(hole.max_from, hole.max);
  const AxisDistance back = axis_distance(frame, square(0, 1), 1e-4);
  EXPECT_EQ(back.max, hole.max);
  EXPECT_EQ(back.max_from, 0.0);
  EXPECT_THROW(axis_distance(frame, frame, 0), InputError);
}

}  // namespace
}  // namespace orchard
