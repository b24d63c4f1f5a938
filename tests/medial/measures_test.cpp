// The papers' measures and those of how an axis is made, on axes and solids of which they are known.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "orchard/medial/paper_measures.h"
#include "orchard/medial/quality.h"
#include "orchard/medial/shape_measures.h"
#include "quality/envelope_samples.h"
#include "support/shapes.h"

namespace orchard {
namespace {

MedialMesh completed(MedialMesh mesh) {
  complete(mesh);
  return mesh;
}

// Three squares of n x n cells around a common edge of length 1, and a curve of length 3 from its end.
MedialMesh three_squares(std::size_t n) {
  MedialMesh mesh;
  std::vector<std::vector<std::vector<Index>>> number(3);
  for (std::size_t sheet = 0; sheet < 3; ++sheet) {
    for (std::size_t i = 0; i <= n; ++i) {
      number[sheet].emplace_back();
      for (std::size_t j = 0; j <= n; ++j) {
        if (sheet > 0 && i == 0) {
          number[sheet][0].push_back(number[0][0][j]);
          continue;
        }
        const double side = static_cast<double>(n), out = static_cast<double>(i) / side;
        const double turn = 2 * std::numbers::pi / 3 * static_cast<double>(sheet);
        number[sheet][i].push_back(mesh.size());
        mesh.centers.emplace_back(out * std::cos(turn), out * std::sin(turn), static_cast<double>(j) / side);
        mesh.radii.push_back(0.5);
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const Index a = number[sheet][i][j], b = number[sheet][i + 1][j], c = number[sheet][i + 1][j + 1],
                    d = number[sheet][i][j + 1];
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      }
    }
  }
  mesh.edges.push_back({0, mesh.size()});
  mesh.centers.emplace_back(0, 0, -3);
  mesh.radii.push_back(0.1);
  return completed(mesh);
}

TEST(ShapeMeasures, OfOneEquilateralTriangleAreOne) {
  const MedialMesh mesh = completed({.centers = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}},
                                     .radii = {1, 1, 1},
                                     .edges = {},
                                     .triangles = {{0, 1, 2}}});
  const ShapeMeasures own = shape_measures(mesh, 2);
  EXPECT_NEAR(own.quality_mean, 1, 1e-12);
  EXPECT_NEAR(own.edge_spread, 1, 1e-12);
  EXPECT_EQ(own.sheets, 1u);
  EXPECT_EQ(own.tiny_sheets, 1u);
  EXPECT_EQ(own.border_turns, 1);
}

TEST(ShapeMeasures, OfSheetsAroundASeamAreThoseByHand) {
  const ShapeMeasures own = shape_measures(three_squares(10), 1);
  EXPECT_EQ(own.sheets, 3u);
  EXPECT_EQ(own.small_sheets, 0u);
  EXPECT_EQ(own.tiny_sheets, 0u);
  EXPECT_NEAR(own.seam_length, 1, 1e-12);
  EXPECT_NEAR(own.curve_length, 3, 1e-12);
  EXPECT_NEAR(own.quality_mean, 6 / std::sqrt(3.0) * 0.5 / ((2 + std::sqrt(2.0)) / 2 * std::sqrt(2.0)), 1e-12);
  // Two corners each; the ends of the seam have three border edges.
  EXPECT_NEAR(own.border_turns, 6.0 / own.border_vertices, 1e-12);
  EXPECT_EQ(own.forked_borders, 2u);
  EXPECT_EQ(own.flaps, 0u);
}

TEST(ShapeMeasures, OfSheetsBelowTheirRadiusCountThem) {
  MedialMesh mesh = three_squares(2);
  for (double& radius : mesh.radii) radius = 3;
  EXPECT_EQ(shape_measures(mesh, 1).small_sheets, 3u);
}

TEST(ShapeMeasures, OfBallsAloneAreNotDefined) {
  const MedialMesh mesh{.centers = {{0, 0, 0}}, .radii = {1}, .edges = {}, .triangles = {}};
  const ShapeMeasures own = shape_measures(mesh, 1);
  EXPECT_TRUE(std::isnan(own.quality_mean));
  EXPECT_TRUE(std::isnan(own.border_turns));
  EXPECT_EQ(own.sheets, 0u);
}

// A capsule: its boundary has the distance 1 from its line, and its area is known.
TEST(EnvelopeSamples, LieOnTheBoundaryAsEvenlyAsItsArea) {
  const MedialMesh mesh =
      completed({.centers = {{0, 0, 0}, {4, 0, 0}}, .radii = {1, 1}, .edges = {{0, 1}}, .triangles = {}});
  const std::vector<Point> samples = detail::envelope_samples(mesh, detail::Reconstruction(mesh), 4000, 1);
  ASSERT_EQ(samples.size(), 4000u);
  std::size_t on_side = 0;
  for (const Point& p : samples) {
    const double along = std::clamp(p.x(), 0.0, 4.0);
    EXPECT_NEAR((p - Point(along, 0, 0)).norm(), 1, 2e-9);
    on_side += p.x() > 0 && p.x() < 4;
  }
  EXPECT_NEAR(static_cast<double>(on_side) / 4000, 4.0 / 6, 0.03);
}

TEST(EnvelopeSamples, OfASlabAreOnItsTwoFacesAndItsRim) {
  const MedialMesh mesh = completed({.centers = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}},
                                     .radii = {0.5, 0.25, 0.125},
                                     .edges = {},
                                     .triangles = {{0, 1, 2}}});
  const detail::Reconstruction whole(mesh);
  const std::vector<Point> samples = detail::envelope_samples(mesh, whole, 1000, 1);
  ASSERT_EQ(samples.size(), 1000u);
  for (const Point& p : samples) EXPECT_NEAR(whole.distance(p), 0, 1e-9);
}

TEST(PaperMeasures, OfABallInABallAreItsSamplingError) {
  const Surface ball(test::icosphere(4));
  const MedialMesh exact{.centers = {{0, 0, 0}}, .radii = {1}, .edges = {}, .triangles = {}};
  const PaperMeasures own = paper_measures(ball, exact, {.samples = 2000});
  const double diagonal = ball.bounding_box().diagonal().norm();
  // The mean distance to the nearest of n random points on an area A is 0.5 sqrt(A / n), both ways.
  EXPECT_NEAR(own.chamfer * diagonal, std::sqrt(4 * std::numbers::pi / 2000), 0.01);
  EXPECT_EQ(own.covered, 1);
  EXPECT_LT(own.dilation_needed, 1e-3);
  EXPECT_TRUE(std::isnan(own.wrong_structure));
  const MedialMesh small{.centers = {{0, 0, 0}}, .radii = {0.9}, .edges = {}, .triangles = {}};
  const PaperMeasures less = paper_measures(ball, small, {.samples = 2000});
  EXPECT_NEAR(less.dilation_needed, 0.05, 1e-3) << "a tenth of the radius, over the longest side of 2";
  EXPECT_EQ(less.covered, 0);
  EXPECT_NEAR(less.sampled_hausdorff * diagonal, 0.15, 0.06);
}

// The seam of a square bar's axis touches four walls; one that is moved towards a wall touches that alone.
TEST(PaperMeasures, CountSeamBallsThatTouchTooFewPlaces) {
  const Surface bar(test::box({0, 0, 0}, {10, 2, 2}));
  // Four sheets from its middle line to its edges.
  MedialMesh mesh;
  for (int i = 0; i <= 4; ++i) {
    const double x = 2 + 1.5 * i;
    for (const Point& p : {Point(x, 1, 1), Point(x, 0, 0), Point(x, 2, 0), Point(x, 0, 2), Point(x, 2, 2)}) {
      mesh.centers.push_back(p);
      mesh.radii.push_back(p.y() == 1 ? 1 : 0);
    }
    if (i == 0) continue;
    const Index a = static_cast<Index>(5 * (i - 1)), b = a + 5;
    for (Index k = 1; k < 5; ++k) {
      mesh.triangles.push_back({a, static_cast<Index>(a + k), b});
      mesh.triangles.push_back({static_cast<Index>(a + k), b, static_cast<Index>(b + k)});
    }
  }
  for (auto& triangle : mesh.triangles) std::sort(triangle.begin(), triangle.end());
  complete(mesh);
  const PaperMeasures right = paper_measures(bar, mesh, {.samples = 500});
  EXPECT_EQ(right.structure_balls, 5u);
  EXPECT_EQ(right.wrong_structure, 0);
  for (std::size_t i = 0; i < mesh.centers.size(); i += 5) mesh.centers[i].y() = 0.4, mesh.radii[i] = 0.4;
  EXPECT_EQ(paper_measures(bar, mesh, {.samples = 500}).wrong_structure, 1);
}

// What is known in closed form lies within the proven bounds.
void expect_within_bounds(const Surface& surface, const MedialMesh& mesh, double open, double beyond) {
  const QualityOptions options{
      .surface_samples = 2000, .contact_cells = 100, .economy_candidates = 100, .economy_samples = 100};
  const MedialQuality quality = medial_quality(surface, mesh, options);
  EXPECT_LE(quality.coverage.max * quality.diagonal, open + 1e-9);
  EXPECT_GE(quality.coverage_upper * quality.diagonal, open - 1e-9);
  EXPECT_LE(quality.protrusion.max * quality.diagonal, beyond + 1e-9);
  EXPECT_GE(quality.protrusion_upper * quality.diagonal, beyond - 1e-9);
}

TEST(ClosedForms, OfOneBallInABoxLieWithinTheProvenBounds) {
  const Surface cube(test::box({-1, -1, -1}, {1, 1, 1}));
  const MedialMesh inscribed{.centers = {{0, 0, 0}}, .radii = {1}, .edges = {}, .triangles = {}};
  expect_within_bounds(cube, inscribed, std::sqrt(3.0) - 1, 0);
  const MedialMesh larger{.centers = {{0, 0, 0}}, .radii = {1.25}, .edges = {}, .triangles = {}};
  expect_within_bounds(cube, larger, std::sqrt(3.0) - 1.25, 0.25);
}

TEST(ClosedForms, OfABallOfTheSameCentreLieWithinTheProvenBounds) {
  const Surface ball(test::icosphere(4));
  const MedialMesh larger{.centers = {{0, 0, 0}}, .radii = {1.5}, .edges = {}, .triangles = {}};
  const MedialQuality quality = medial_quality(ball, larger, {.surface_samples = 2000});
  // The facets are a little nearer than their corners.
  EXPECT_GE(quality.protrusion_upper * quality.diagonal, 0.5);
  EXPECT_LT(quality.protrusion_upper * quality.diagonal, 0.51);
}

TEST(ClosedForms, OfTheLineOfACylinderLieWithinTheProvenBounds) {
  const Surface cylinder(test::turned({{1, 0}, {1, 6}}, 256));
  const MedialMesh line =
      completed({.centers = {{0, 0, 1}, {0, 0, 5}}, .radii = {1, 1}, .edges = {{0, 1}}, .triangles = {}});
  const QualityOptions options{.surface_samples = 2000};
  const MedialQuality quality = medial_quality(cylinder, line, options);
  // The rims are sqrt(2) from the ends of the line.
  EXPECT_GE(quality.coverage_upper * quality.diagonal, std::sqrt(2.0) - 1 - 1e-9);
  EXPECT_LE(quality.coverage.max * quality.diagonal, std::sqrt(2.0) - 1 + 1e-9);
  const double facet = 1 - std::cos(std::numbers::pi / 256);
  EXPECT_NEAR(quality.protrusion_upper * quality.diagonal, facet, 1e-4);
}

TEST(ClosedForms, OfTheCircleOfATorusLieWithinTheProvenBounds) {
  const Surface torus(test::torus(256, 128));
  MedialMesh circle;
  for (int i = 0; i < 256; ++i) {
    const double turn = 2 * std::numbers::pi * i / 256;
    circle.centers.emplace_back(std::cos(turn), std::sin(turn), 0);
    circle.radii.push_back(0.3);
    circle.edges.push_back({static_cast<Index>(i), static_cast<Index>((i + 1) % 256)});
  }
  for (auto& edge : circle.edges) std::sort(edge.begin(), edge.end());
  const MedialQuality quality = medial_quality(torus, completed(circle), {.surface_samples = 2000});
  // The torus of radius .35 is .05 outside all around, up to the facets of its mesh and the chords of the circle.
  const double chords = 1.35 * (1 - std::cos(std::numbers::pi / 256)) + 0.35 * (1 - std::cos(std::numbers::pi / 128));
  EXPECT_GE(quality.coverage_upper * quality.diagonal, 0.05 - 1e-9);
  EXPECT_LE(quality.coverage_upper * quality.diagonal, 0.05 + 2 * chords);
  EXPECT_EQ(quality.found, quality.wanted);
}

TEST(ClosedForms, OfTheSheetOfAWedgeLieWithinTheProvenBounds) {
  // A prism over a right-angled isosceles triangle: its largest ball leaves the far corner open.
  const Surface wedge(test::prism({{0, 0}, {4, 0}, {0, 4}}, {{0, 1, 2}}, 8));
  const double r = 4 / (2 + std::sqrt(2.0));  // of the circle inside the triangle
  const MedialMesh line =
      completed({.centers = {{r, r, r}, {r, r, 8 - r}}, .radii = {r, r}, .edges = {{0, 1}}, .triangles = {}});
  const double far = std::hypot(4 - r, r, r) - r;
  expect_within_bounds(wedge, line, far, 0);
}

}  // namespace
}  // namespace orchard
