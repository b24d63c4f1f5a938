// What the refined axis does where it leaves the surface open, and the cells that it takes away in the end.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "balls/split.h"
#include "known_axes.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/build.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"
#include "outlines.h"
#include "quality/reconstruction.h"
#include "reach/dents_below.h"
#include "reach/uncovered.h"
#include "refine/drop_degenerate.h"
#include "support.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

// That reach for all that is left open, however few the points are.
MedialBuildOptions reaching(Index points, std::uint64_t seed = 1) {
  RefineOptions refine;
  refine.reach_detail = 0;
  return {.sampling = {.face_points = points - points / 5, .edge_points = points / 5, .seed = seed}, .refine = refine};
}

using test::diagonal;

// A box with a blunt pyramid for a lid: its apex has no sharp edge at it, and stands out by more than an edge would.
TriangleMesh box_with_lid(double height) {
  TriangleMesh mesh;
  for (const double z : {0.0, 1.0})
    for (const double y : {0.0, 1.0})
      for (const double x : {0.0, 1.0}) mesh.vertices.push_back({x, y, z});
  mesh.vertices.push_back({0.5, 0.5, 1 + height});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {0, 1, 5}, {0, 5, 4}, {1, 3, 7}, {1, 7, 5}, {3, 2, 6},
                    {3, 6, 7}, {2, 0, 4}, {2, 4, 6}, {4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}};
  return mesh;
}

// The ridges of the lid lose less than what features lose here.
TEST(RefineAxis, ReachesForPlacesThatStandOutWithoutASharpEdge) {
  for (const double height : {0.08, 0.15, 0.22}) {
    SCOPED_TRACE(height);
    const Surface surface(box_with_lid(height));
    for (std::uint64_t seed = 1; seed <= test::more(); ++seed) {
      MedialBuildOptions options = reaching(500, test::first_seed() + seed);
      options.refine->feature_loss = 0.05;
      const MedialBuild build = build_medial_axis(surface, options);
      EXPECT_EQ(build.features.size(), 12u);
      EXPECT_GT(build.refinement.reached_places, 0u);
      const MedialMesh mesh = medial_mesh(build.axis);
      const detail::Reconstruction reconstruction(mesh);
      const double limit = 2 * RefineOptions{}.border_loss * diagonal(surface);
      for (const Point& vertex : surface.mesh().vertices) EXPECT_LE(reconstruction.distance(vertex), limit);
      EXPECT_EQ(topology(mesh), (Topology{1, 0, 0}));
      for (Index v = 0; v < mesh.size(); ++v)
        ASSERT_NEAR(mesh.radii[v], surface.distance(mesh.centers[v]), 1e-9 * diagonal(surface));
    }
  }
}

TEST(UncoveredSearch, FindsTheCornersThatASphereInABoxLeavesOpen) {
  const Surface box(test::known_box({2, 2, 2}).solid);
  const Point middle = 0.5 * (box.bounding_box().min() + box.bounding_box().max());
  const detail::Reconstruction sphere({.centers = {middle}, .radii = {1}, .edges = {}, .triangles = {}});
  detail::UncoveredSearch search(box, 0.6, 0.01, 0.01);
  const auto corners = search.find(sphere, 0.5);
  ASSERT_EQ(corners.size(), 8u);
  for (const detail::UncoveredPlace& corner : corners) EXPECT_NEAR(corner.value, std::sqrt(3.0) - 1, 1e-12);
  // The middles of edges are open by .41.
  EXPECT_EQ(detail::UncoveredSearch(box, 0.4, 0.01, 0.01).find(sphere, 0.9).size(), 20u);
  EXPECT_TRUE(detail::UncoveredSearch(box, 0.74, 0.01, 0.01).find(sphere, 0.5).empty());
}

TEST(UncoveredSearch, LooksAgainOnlyWhereItIsToldThatBallsAreGone) {
  const Surface box(test::known_box({2, 2, 2}).solid);
  const Point middle = 0.5 * (box.bounding_box().min() + box.bounding_box().max());
  const Point low = box.bounding_box().min(), high = box.bounding_box().max();
  MedialMesh balls{.centers = {middle, low, high}, .radii = {1, 0.5, 0.5}, .edges = {}, .triangles = {}};
  detail::UncoveredSearch search(box, 0.6, 0.01, 0.01);
  EXPECT_EQ(search.find(detail::Reconstruction(balls), 0.5).size(), 6u);
  balls.centers.resize(2);
  balls.radii.resize(2);
  EXPECT_EQ(search.find(detail::Reconstruction(balls), 0.5).size(), 6u);
  search.look_again(std::vector<Sphere>{{high, 0.5}});
  EXPECT_EQ(search.find(detail::Reconstruction(balls), 0.5).size(), 7u);
  EXPECT_EQ(search.find(detail::Reconstruction(balls), 0.5).size(), 7u);
}

TEST(SplitErrors, ForgetCellsWhoseVerticesAreGone) {
  detail::SplitErrors errors;
  errors.edges = {.cells = {{0, 1}, {1, 2}, {2, 3}}, .errors = {1, 2, 3}};
  errors.triangles = {.cells = {{0, 1, 2}, {1, 2, 3}}, .errors = {4, -5}};
  errors.renumber({kNone, 0, 1, 2});
  EXPECT_EQ(errors.edges.cells, (std::vector<std::array<Index, 2>>{{0, 1}, {1, 2}}));
  EXPECT_EQ(errors.edges.errors, (std::vector<double>{2, 3}));
  EXPECT_EQ(errors.triangles.cells, (std::vector<std::array<Index, 3>>{{0, 1, 2}}));
  EXPECT_EQ(errors.triangles.errors, (std::vector<double>{-5}));
}

// Its axis is a disk. From facet to facet what the sheet loses jumps, so that its border would go in steps.
TEST(RefineAxis, TheBorderOfAFlatEllipsoidIsHardlyLongerThanItsCircle) {
  TriangleMesh mesh = test::icosphere(4);
  for (Point& vertex : mesh.vertices) vertex.z() *= 0.3;
  const Surface surface(mesh);
  const double circle = 2 * std::numbers::pi * (1 - 0.3 * 0.3);
  const std::uint64_t seeds = 4 * test::more();
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const MedialBuild build = build_medial_axis(surface, reaching(2000, test::first_seed() + seed));
    sum += build.refinement.border_length * diagonal(surface);
  }
  EXPECT_LT(sum / static_cast<double>(seeds), 1.04 * circle);
}

TEST(DentsBelow, FindsTheDeepPlacesThatASphereInABoxLeavesBelowCorners) {
  const Surface box(test::known_box({2, 2, 2}).solid);
  const Point middle = 0.5 * (box.bounding_box().min() + box.bounding_box().max());
  const detail::Reconstruction sphere({.centers = {middle}, .radii = {1}, .edges = {}, .triangles = {}});
  const double deepest = 1 - 1 / std::sqrt(3.0);
  const auto dents = detail::DentsBelow(box, 0.3, 0.01).find(sphere, 0.5);
  ASSERT_GE(dents.size(), 8u);
  std::set<std::array<bool, 3>> octants;
  for (const detail::UncoveredPlace& dent : dents) {
    EXPECT_GT(dent.value, 1.1 * 0.3);
    EXPECT_LE(dent.value, deepest + 1e-3);
    EXPECT_NEAR(sphere.distance(dent.inside), 0, 1e-3);
    EXPECT_NEAR(box.distance(dent.inside), dent.value, 1e-12);
    EXPECT_NEAR((dent.position - dent.inside).norm(), dent.value, 1e-12);
    const Vector to = dent.inside - middle;
    octants.insert({to.x() > 0, to.y() > 0, to.z() > 0});
  }
  EXPECT_EQ(octants.size(), 8u);
  EXPECT_NEAR(dents.front().value, deepest, 0.03);
  // No place is as deep as 1.1 times this.
  EXPECT_TRUE(detail::DentsBelow(box, 0.4, 0.01).find(sphere, 0.5).empty());
}

TEST(DentsBelow, FindsNothingWhereBallsFillTheSolidUpToAnEdge) {
  const Surface box(test::known_box({2, 2, 2}).solid);
  const MedialBuild build = build_medial_axis(box, reaching(500));
  const detail::Reconstruction reconstruction(medial_mesh(build.axis));
  EXPECT_TRUE(detail::DentsBelow(box, 0.01, 0.002).find(reconstruction, 0.1).empty());
}

// A house: its ridge is no sharp edge, and all of it stands out.
Surface house(double height) {
  const test::Outline outline{{{0, 0}}, {{1, 0}}, {{1, 0.6}}, {{0.5, 0.6 + height}}, {{0, 0.6}}};
  return Surface(test::extruded(outline, 3));
}

// Returns the largest distance of the house's ridge from what an axis stands for.
double farthest_on_ridge(const MedialMesh& mesh, double height) {
  const detail::Reconstruction reconstruction(mesh);
  double farthest = 0;
  for (int i = 0; i <= 300; ++i) farthest = std::max(farthest, reconstruction.distance({0.5, 0.6 + height, 0.01 * i}));
  return farthest;
}

TEST(RefineAxis, WhatReachesForARidgeIsOneSheetWithAStraightBorder) {
  Index reached = 0;
  for (const double height : {0.07, 0.1, 0.15}) {
    SCOPED_TRACE(height);
    const Surface surface = house(height);
    MedialBuildOptions options = reaching(1000);
    const MedialBuild build = build_medial_axis(surface, options);
    options.refine->reach_rounds = 0;
    const MedialBuild without = build_medial_axis(surface, options);
    const MedialMesh mesh = medial_mesh(build.axis);
    EXPECT_LE(farthest_on_ridge(mesh, height), 1.96 * RefineOptions{}.border_loss * diagonal(surface));
    // Teeth side by side would double it.
    EXPECT_LE(build.refinement.border_length, 1.25 * without.refinement.border_length);
    EXPECT_EQ(topology(mesh), (Topology{1, 0, 0}));
    reached += build.refinement.reached_places;
  }
  EXPECT_GT(reached, 0u);
}

// Along a roller, a ridge so narrow that no sheet leads there, which stands out by a little more than is left open.
TEST(RefineAxis, WhatStandsOutAlongARidgeFarFromTheAxisGetsNoSpikes) {
  constexpr double kLength = 1.2, kWidth = 0.06, kHeight = 0.008;
  constexpr int kSides = 48;
  test::Outline outline{{{1, -kWidth / 2}}, {{1 + kHeight, 0}}, {{1, kWidth / 2}}};
  for (int i = 1; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    outline.push_back({std::cos(angle), std::sin(angle)});
  }
  const Surface roller(test::extruded(outline, kLength));
  for (const Index points : {2000u, 8000u}) {
    SCOPED_TRACE(points);
    MedialBuildOptions options = reaching(points, test::first_seed() + 1);
    const MedialBuild build = build_medial_axis(roller, options);
    options.refine->reach_rounds = 0;
    const MedialBuild without = build_medial_axis(roller, options);
    EXPECT_GT(build.refinement.reached_places, 5u);
    const double longer = build.refinement.border_length - without.refinement.border_length;
    // Once along the ridge, and in and out twice: a spike for each place would have ten times as much.
    EXPECT_LE(longer * diagonal(roller), kLength + 4);
  }
}

detail::ExactBall ball_at(const Point& center) {
  detail::ExactBall ball;
  ball.center = center;
  ball.radius = 1;
  return ball;
}

// Three sheets that meet in a line, with triangles that have no area: on edges, and between vertices at one place.
detail::BallComplex sheets_with_degenerate_cells(std::mt19937_64& random) {
  detail::BallComplex complex;
  constexpr Index kRows = 5, kColumns = 4;
  std::uniform_real_distribution<double> uneven(-0.1, 0.1);
  std::vector<std::array<Index, kColumns>> rows;
  for (int sheet = 0; sheet < 3; ++sheet) {
    const double angle = 2.0 * sheet;
    const std::size_t first = rows.size();
    for (Index row = 0; row < kRows; ++row) {
      std::array<Index, kColumns> vertices{};
      for (Index column = 0; column < kColumns; ++column) {
        vertices[column] = complex.size();
        if (column == 0 && sheet > 0) {
          vertices[0] = rows[row][0];
          continue;
        }
        const double x = column + uneven(random);
        complex.balls.push_back(ball_at({x * std::cos(angle), x * std::sin(angle), row + uneven(random)}));
      }
      rows.push_back(vertices);
    }
    for (std::size_t row = first; row + 1 < rows.size(); ++row) {
      for (Index column = 0; column + 1 < kColumns; ++column) {
        const Index a = rows[row][column], b = rows[row][column + 1], c = rows[row + 1][column],
                    d = rows[row + 1][column + 1];
        complex.triangles.push_back({a, b, c});
        complex.triangles.push_back({b, c, d});
      }
    }
  }
  complex.complete();
  const std::vector<std::array<Index, 2>> edges = complex.edges;
  for (const auto& [a, b] : edges) {
    const auto kind = random() % 6;
    const double t = kind == 0 ? 0 : 0.25 + 0.5 * std::generate_canonical<double, 53>(random);
    if (kind > 1) continue;
    complex.triangles.push_back({a, b, complex.size()});
    complex.balls.push_back(ball_at((1 - t) * complex.balls[a].center + t * complex.balls[b].center));
  }
  complex.complete();
  return complex;
}

TEST(DropDegenerate, LeavesNoTriangleWithoutAreaAndTheSameTopology) {
  for (std::uint64_t seed = 0; seed < 30 * test::more(); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(test::first_seed() + seed);
    detail::BallComplex complex = sheets_with_degenerate_cells(random);
    const MedialMesh before = complex.mesh();
    ASSERT_GT(detail::drop_degenerate(complex, 1e-9), 0u);
    const MedialMesh after = complex.mesh();
    EXPECT_EQ(topology(after), topology(before));
    for (const auto& [a, b, c] : after.triangles) {
      const Vector u = after.centers[b] - after.centers[a], v = after.centers[c] - after.centers[a];
      EXPECT_GT(u.cross(v).norm(), 1e-6);
    }
    // All of what is left was there, and at its place.
    const auto key = [](const Point& place) { return std::array{place.x(), place.y(), place.z()}; };
    std::set<std::array<double, 3>> places;
    for (const Point& center : before.centers) places.insert(key(center));
    for (const Point& center : after.centers) EXPECT_TRUE(places.erase(key(center)) == 1);
    EXPECT_TRUE(places.empty());
  }
}

TEST(DropDegenerate, LeavesWhatTheTopologyNeeds) {
  // A hollow tetrahedron without volume, two of whose vertices are one place.
  detail::BallComplex complex;
  for (const Point& center : {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(0, 0, 0)})
    complex.balls.push_back(ball_at(center));
  complex.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  complex.complete();
  EXPECT_EQ(detail::drop_degenerate(complex, 1e-6), 0u);
  EXPECT_EQ(topology(complex.mesh()), (Topology{1, 0, 1}));
}

}  // namespace
}  // namespace orchard
