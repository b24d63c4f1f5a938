// The strata of a medial complex, and what may be drawn together.
#include "remesh/sheet_mesh.h"

#include <gtest/gtest.h>

namespace orchard {
namespace {

using detail::BallComplex;
using detail::SheetMesh;
using detail::Stratum;

BallComplex balls_of(Index vertices, std::vector<std::array<Index, 3>> triangles,
                     std::vector<std::array<Index, 2>> edges = {}) {
  BallComplex complex;
  complex.balls.resize(vertices);
  for (Index v = 0; v < vertices; ++v) complex.balls[v].center = Point(v, v * v, 0);
  complex.triangles = std::move(triangles);
  complex.edges = std::move(edges);
  complex.complete();
  return complex;
}

// A fan of six triangles around vertex 0.
BallComplex fan() { return balls_of(7, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 1, 6}}); }

// Three triangles on each of two edges 0 1 and 1 2: a seam, at which three sheets meet.
BallComplex seam_complex() {
  return balls_of(9,
                  {{0, 1, 3}, {1, 2, 3}, {1, 3, 4}, {0, 1, 5}, {1, 2, 5}, {1, 5, 6}, {0, 1, 7}, {1, 2, 7}, {1, 7, 8}});
}

TEST(SheetMesh, TellsSheetsFromBorders) {
  const SheetMesh mesh(fan());
  EXPECT_EQ(mesh.stratum(0), Stratum::sheet);
  EXPECT_EQ(mesh.stratum(0, 1), Stratum::sheet);
  for (Index v = 1; v <= 6; ++v) EXPECT_EQ(mesh.stratum(v), Stratum::border);
  EXPECT_EQ(mesh.stratum(1, 2), Stratum::border);
}

TEST(SheetMesh, TellsSeamsCurvesAndJunctions) {
  const SheetMesh three(balls_of(5, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}));
  EXPECT_EQ(three.stratum(0, 1), Stratum::seam);
  EXPECT_EQ(three.stratum(0), Stratum::junction);  // where the seam ends, three borders do
  const SheetMesh curve(balls_of(4, {}, {{0, 1}, {1, 2}}));
  EXPECT_EQ(curve.stratum(1), Stratum::curve);
  EXPECT_EQ(curve.stratum(0), Stratum::junction);
  EXPECT_EQ(curve.stratum(3), Stratum::junction);  // alone
  EXPECT_EQ(curve.cells(), 3u);
}

TEST(SheetMesh, TellsAVertexInASeam) {
  const SheetMesh mesh(seam_complex());
  EXPECT_EQ(mesh.stratum(0, 1), Stratum::seam);
  // Its link is a theta only without the fins 1 3 4, 1 5 6 and 1 7 8, whose borders end there.
  EXPECT_EQ(mesh.stratum(1), Stratum::junction);
  SheetMesh plain(balls_of(6, {{0, 1, 3}, {1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {0, 1, 5}, {1, 2, 5}}));
  EXPECT_EQ(plain.stratum(1), Stratum::seam);
  plain.pin(1);
  EXPECT_EQ(plain.stratum(1), Stratum::junction);
}

TEST(SheetMesh, TellsTwoSheetsThatTouchInAPointApart) {
  const SheetMesh mesh(balls_of(5, {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_EQ(mesh.stratum(0), Stratum::junction);
  EXPECT_EQ(mesh.stratum(1), Stratum::border);
}

TEST(SheetMesh, GivesBackWhatItWasMadeOf) {
  const BallComplex complex = fan();
  const SheetMesh mesh(complex);
  const BallComplex again = mesh.complex();
  EXPECT_EQ(again.edges, complex.edges);
  EXPECT_EQ(again.triangles, complex.triangles);
}

TEST(SheetMesh, CanUndoAChange) {
  const BallComplex complex = fan();
  SheetMesh mesh(complex);
  const SheetMesh::Cell gone = mesh.corners(0);
  const Index first = mesh.cells();
  mesh.remove(0);
  EXPECT_EQ(mesh.stratum(0), Stratum::border);
  mesh.add({1, 2, 4});
  mesh.take_back(first);
  mesh.put_back(0, gone);
  EXPECT_EQ(mesh.stratum(0), Stratum::sheet);
  EXPECT_EQ(mesh.complex().triangles, complex.triangles);
}

TEST(SheetMesh, DrawsTogetherNoHoleAndNoBubble) {
  const SheetMesh disc(fan());
  EXPECT_TRUE(disc.contractible(0, 1));
  EXPECT_TRUE(disc.contractible(1, 2));
  // Three edges around a hole.
  const SheetMesh hole(balls_of(3, {}, {{0, 1}, {1, 2}, {0, 2}}));
  EXPECT_FALSE(hole.contractible(0, 1));
  // Four triangles around a cavity.
  const SheetMesh bubble(balls_of(4, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}));
  EXPECT_FALSE(bubble.contractible(0, 1));
}

}  // namespace
}  // namespace orchard
