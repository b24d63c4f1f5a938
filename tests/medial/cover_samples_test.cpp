// Whether changes to a medial complex leave places of the surface covered, one after the other.
#include "remesh/cover_samples.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "orchard/geometry/random.h"
#include "quality/reconstruction.h"

namespace orchard {
namespace {

using detail::BallComplex;
using detail::CoverSamples;
using detail::SheetMesh;

constexpr double kStep = 0.25;
constexpr Index kEnd = 8;

// Balls of radius 1 along x, joined by bare edges of length kStep.
SheetMesh rod() {
  BallComplex complex;
  for (Index v = 0; v <= kEnd; ++v) complex.balls.push_back({.center = Point(kStep * v, 0, 0), .radius = 1});
  for (Index v = 0; v < kEnd; ++v) complex.edges.push_back({v, v + 1});
  complex.complete();
  return SheetMesh(complex);
}
// Where the rod's surface ends.
Point tip() { return {kStep * kEnd + 1, 0, 0}; }

Index cell_between(const SheetMesh& mesh, Index a, Index b) {
  for (Index cell = 0; cell < mesh.cells(); ++cell) {
    if (mesh.alive(cell) && mesh.corners(cell) == SheetMesh::Cell{a, b, b}) return cell;
  }
  return kNone;
}

// Takes the last edge away if its places stay covered by what is left.
bool shorten(SheetMesh& mesh, CoverSamples& cover, Index last) {
  const Index cell = cell_between(mesh, last - 1, last);
  if (cell == kNone) return true;  // it was taken away before
  const SheetMesh::Cell corners = mesh.corners(cell);
  mesh.remove(cell);
  const std::array<Index, 1> old{cell}, touched{last - 1};
  if (cover.stay_covered(mesh, old, {}, touched)) {
    cover.settle();
    return true;
  }
  mesh.put_back(cell, corners);
  return false;
}

TEST(CoverSamples, DistancesAreThoseToTheNearestOfAllBalls) {
  Random random(1, 2);
  const auto point = [&] { return Point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
  BallComplex complex;
  for (int v = 0; v < 12; ++v) complex.balls.push_back({.center = point(), .radius = random.uniform(0, 0.3)});
  complex.triangles = {{0, 1, 2}, {1, 2, 3}, {3, 4, 5}};
  complex.edges = {{5, 6}, {7, 8}, {8, 9}};  // 10 and 11 are alone
  complex.complete();
  std::vector<Point> places;
  for (int i = 0; i < 500; ++i) places.push_back(2 * point());
  const CoverSamples cover(SheetMesh(complex), places, 0.1);
  const detail::Reconstruction reconstruction(complex.mesh());
  ASSERT_EQ(cover.size(), places.size());
  for (Index i = 0; i < cover.size(); ++i) EXPECT_DOUBLE_EQ(cover.distance(i), reconstruction.distance(places[i]));
}

// Each step loses a quarter of the limit, and only four of them are allowed.
TEST(CoverSamples, LossesAddUp) {
  const std::vector<Point> places{tip()};
  SheetMesh mesh = rod();
  CoverSamples cover(mesh, places, 4.01 * kStep);
  EXPECT_NEAR(cover.distance(0), 0, 1e-12);
  for (Index k = 0; k < 4; ++k) {
    ASSERT_TRUE(shorten(mesh, cover, kEnd - k)) << k;
    EXPECT_NEAR(cover.distance(0), kStep * (k + 1), 1e-12);
  }
  EXPECT_FALSE(shorten(mesh, cover, kEnd - 4));
  EXPECT_NEAR(cover.distance(0), 4 * kStep, 1e-12);
}

TEST(CoverSamples, AChangeThatUncoversIsRefusedAndForgotten) {
  const std::vector<Point> places{tip(), Point(0, 1, 0)};
  SheetMesh mesh = rod();
  CoverSamples cover(mesh, places, 0.9 * kStep);
  EXPECT_FALSE(shorten(mesh, cover, kEnd));
  EXPECT_FALSE(shorten(mesh, cover, kEnd)) << "the second time is like the first";
  for (Index i = 0; i < cover.size(); ++i) EXPECT_NEAR(cover.distance(i), 0, 1e-12);
}

TEST(CoverSamples, WhatIsNotSettledIsForgotten) {
  const std::vector<Point> places{tip()};
  SheetMesh mesh = rod();
  CoverSamples cover(mesh, places, 1.01 * kStep);
  const Index cell = cell_between(mesh, kEnd - 1, kEnd);
  const SheetMesh::Cell corners = mesh.corners(cell);
  const std::array<Index, 1> old{cell}, touched{kEnd - 1};
  for (int time = 0; time < 2; ++time) {
    mesh.remove(cell);
    EXPECT_TRUE(cover.stay_covered(mesh, old, {}, touched));
    mesh.put_back(cell, corners);
    EXPECT_NEAR(cover.distance(0), 0, 1e-12);
  }
  EXPECT_TRUE(shorten(mesh, cover, kEnd));
  EXPECT_FALSE(shorten(mesh, cover, kEnd - 1));
}

// A place that is open beyond the limit may get nearer, but not farther; what it gained is not lost again.
TEST(CoverSamples, WhatIsOpenDoesNotOpenFarther) {
  constexpr double kGap = 0.5;
  const std::vector<Point> places{tip() + Vector(kGap, 0, 0)};
  SheetMesh mesh = rod();
  CoverSamples cover(mesh, places, 0.1);
  const Index last = cell_between(mesh, kEnd - 1, kEnd);
  const std::array<Index, 1> cells{last}, touched{kEnd};
  const auto move = [&](double by) {
    const detail::ExactBall before = mesh.ball(kEnd);
    detail::ExactBall ball = before;
    ball.center.x() += by;
    mesh.set_ball(kEnd, ball);
    if (cover.stay_covered(mesh, cells, cells, touched)) {
      cover.settle();
      return true;
    }
    mesh.set_ball(kEnd, before);
    return false;
  };
  EXPECT_FALSE(move(-0.05));
  EXPECT_TRUE(move(0.2));
  EXPECT_NEAR(cover.distance(0), kGap - 0.2, 1e-12);
  EXPECT_FALSE(move(-0.05));
  EXPECT_TRUE(move(0.3));
  EXPECT_TRUE(move(-0.05)) << "within the limit";
}

// What a cell covers goes to those that are made for it, and is asked of them from then on.
TEST(CoverSamples, PlacesGoToCellsThatAreMade) {
  const std::vector<Point> places{Point(1, 0, 0.1)};
  BallComplex complex;
  for (Index v = 0; v < 4; ++v) complex.balls.push_back({.center = Point(v, 0, 0), .radius = 0.1});
  complex.edges = {{0, 1}, {1, 2}, {2, 3}};
  SheetMesh mesh(complex);
  CoverSamples cover(mesh, places, 0.3);
  const std::array<Index, 2> old{cell_between(mesh, 0, 1), cell_between(mesh, 1, 2)};
  const std::array<SheetMesh::Cell, 2> corners{mesh.corners(old[0]), mesh.corners(old[1])};
  // The first two edges get another vertex between them.
  const auto sag = [&](double by) {
    for (const Index cell : old) mesh.remove(cell);
    const Index middle = mesh.add_vertex({.center = Point(1, 0, -by), .radius = 0.1});
    return std::array<Index, 2>{mesh.add({0, middle, middle}), mesh.add({2, middle, middle})};
  };
  const std::array<Index, 2> touched{0, 2}, too_far = sag(0.6);
  EXPECT_FALSE(cover.stay_covered(mesh, old, too_far, touched));
  mesh.take_back(too_far[0]);
  for (std::size_t i = 0; i < old.size(); ++i) mesh.put_back(old[i], corners[i]);
  const std::array<Index, 2> made = sag(0.2);
  ASSERT_TRUE(cover.stay_covered(mesh, old, made, touched));
  cover.settle();
  EXPECT_NEAR(cover.distance(0), 0.2, 0.02);
  // Without these, too, the nearest is the ball at 2.
  for (const Index cell : made) mesh.remove(cell);
  EXPECT_TRUE(cover.stay_covered(mesh, old, {}, touched)) << "those that are gone have none";
  EXPECT_FALSE(cover.stay_covered(mesh, made, {}, touched));
}

}  // namespace
}  // namespace orchard
