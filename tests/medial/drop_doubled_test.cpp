// Sheets that double others go, and flakes, and nothing else does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"
#include "quality/reconstruction.h"
#include "refine/drop_doubled.h"
#include "refine/drop_flakes.h"
#include "support/effort.h"

namespace orchard {
namespace {

constexpr int kColumns = 12;
constexpr double kApart = 0.01;

detail::ExactBall ball_of(const Point& center, double radius) {
  detail::ExactBall ball;
  ball.center = center;
  ball.radius = radius;
  return ball;
}

// Sheets of squares in two triangles each; the first column of one may be that of another.
struct Sheets {
  detail::BallComplex complex;

  Index add(int rows, double side, double height, double radius, Index first_column = kNone) {
    const Index first = complex.size();
    const auto vertex = [&](int row, int column) {
      if (first_column != kNone && column == 0) return first_column + static_cast<Index>(row);
      const int own = first_column != kNone ? column - 1 : column;
      return first + static_cast<Index>(own * (rows + 1) + row);
    };
    for (int column = first_column != kNone ? 1 : 0; column <= kColumns; ++column)
      for (int row = 0; row <= rows; ++row)
        complex.balls.push_back(ball_of({side * column, side * row, height}, radius));
    for (int column = 0; column < kColumns; ++column)
      for (int row = 0; row < rows; ++row) {
        complex.triangles.push_back({vertex(row, column), vertex(row, column + 1), vertex(row + 1, column)});
        complex.triangles.push_back({vertex(row + 1, column), vertex(row, column + 1), vertex(row + 1, column + 1)});
      }
    complex.complete();
    return first;
  }
};

// How far the balls of a mesh, at places drawn from its triangles, reach out of those of another at most.
double most_outside(const MedialMesh& balls, const MedialMesh& others, std::mt19937_64& random) {
  const detail::Reconstruction reconstruction(others);
  std::uniform_real_distribution<double> part(0, 1);
  double most = 0;
  for (const auto& [a, b, c] : balls.triangles) {
    double u = part(random), v = part(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const double w = 1 - u - v;
    const Point center = u * balls.centers[a] + v * balls.centers[b] + w * balls.centers[c];
    const double radius = u * balls.radii[a] + v * balls.radii[b] + w * balls.radii[c];
    most = std::max(most, reconstruction.distance(center) + radius);
  }
  return most;
}

TEST(DropDoubled, TakesASheetThatLiesOnAnotherWhole) {
  Sheets sheets;
  const Index first = sheets.add(5, 1, 0, 2);
  const std::size_t triangles = sheets.complex.triangles.size();
  const double border = border_length(sheets.complex.mesh());
  sheets.add(5, 1, 0.9 * kApart, 2, first);
  EXPECT_EQ(detail::drop_doubled(sheets.complex, kApart, 0.5), triangles);
  EXPECT_EQ(sheets.complex.triangles.size(), triangles);
  EXPECT_NEAR(border_length(sheets.complex.mesh()), border, kApart);
  EXPECT_EQ(topology(sheets.complex.mesh()), (Topology{1, 0, 0}));
}

TEST(DropDoubled, LeavesWhatIsFartherApartOrSmaller) {
  for (const auto& [height, radius] : {std::pair(1.1 * kApart, 2.0), std::pair(0.0, 2 + 1.1 * kApart)}) {
    Sheets sheets;
    const Index first = sheets.add(5, 1, 0, 2);
    sheets.add(5, 1, height, radius, first);
    // The sheet of smaller balls lies in the other one, which does not lie in it.
    EXPECT_EQ(detail::drop_doubled(sheets.complex, kApart, 0.5) > 0, radius > 2);
    EXPECT_EQ(topology(sheets.complex.mesh()), (Topology{1, 0, 0}));
  }
  Sheets one;
  one.add(5, 1, 0, 2);
  EXPECT_EQ(detail::drop_doubled(one.complex, kApart, 0.5), 0u);
}

TEST(DropDoubled, LeavesWhatHasNoBorder) {
  // Two sheets on one another, closed all around.
  Sheets sheets;
  const Index first = sheets.add(4, 1, 0, 2), second = sheets.add(4, 1, 0.5 * kApart, 2, first);
  const auto of_first = [&](int row, int column) { return first + static_cast<Index>(column * 5 + row); };
  const auto of_second = [&](int row, int column) {
    return column == 0 ? of_first(row, 0) : second + static_cast<Index>((column - 1) * 5 + row);
  };
  const auto join = [&](int row, int column, int next_row, int next_column) {
    sheets.complex.triangles.push_back(
        {of_first(row, column), of_first(next_row, next_column), of_second(next_row, next_column)});
    if (column > 0) {
      sheets.complex.triangles.push_back(
          {of_first(row, column), of_second(row, column), of_second(next_row, next_column)});
    }
  };
  for (int column = 0; column < kColumns; ++column) join(0, column, 0, column + 1), join(4, column, 4, column + 1);
  for (int row = 0; row < 4; ++row) join(row, kColumns, row + 1, kColumns);
  sheets.complex.complete();
  ASSERT_EQ(topology(sheets.complex.mesh()), (Topology{1, 0, 1}));
  EXPECT_EQ(detail::drop_doubled(sheets.complex, kApart, 0.5), 0u);
}

TEST(DropDoubled, ChangesNoTopologyAndLeavesNothingOpenByMore) {
  for (std::uint64_t seed = test::first_seed(), end = seed + 40 * test::more(); seed < end; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> part(0, 1);
    // Layers on one another, from triangles as small as a fraction of `apart` to many times as large.
    Sheets sheets;
    const double side = kApart * std::exp2(8 * part(random) - 3);
    const int rows = 1 + static_cast<int>(5 * part(random)), layers = 1 + static_cast<int>(3 * part(random));
    const Index first = sheets.add(rows, side, 0, 1);
    for (int layer = 0; layer < layers; ++layer)
      sheets.add(rows, side, 0.7 * kApart * (part(random) - 0.5), 1, part(random) < 0.8 ? first : kNone);
    const bool sharp = part(random) < 0.5;  // what ends far from the joint ends in a sharp edge
    for (detail::ExactBall& ball : sheets.complex.balls) {
      const double to_edge = kColumns * side - ball.center.x();
      if (sharp) ball.radius = 0.7 * to_edge;
      if (sharp && to_edge < 0.5 * side) {
        ball.radius = 0;
        continue;
      }
      for (int axis = 0; axis < 3; ++axis) ball.center[axis] += 0.3 * std::min(side, kApart) * (part(random) - 0.5);
      ball.radius += 0.15 * std::min(side, kApart) * (part(random) - 0.5);
    }
    const MedialMesh before = sheets.complex.mesh();
    const Index dropped = detail::drop_doubled(sheets.complex, kApart, 0.5 * side);
    const MedialMesh after = sheets.complex.mesh();
    validate(after);
    EXPECT_EQ(before.triangles.size(), after.triangles.size() + dropped);
    EXPECT_EQ(topology(after), topology(before));
    EXPECT_LE(border_length(after), border_length(before) - (dropped > 0 ? 0.5 * side : 0));
    // Between the places that are looked at balls may lie a little farther out.
    EXPECT_LE(most_outside(before, after, random), 1.3 * kApart);
  }
}

// A triangle that stands on an inner edge of a sheet with balls of radius 1.
detail::BallComplex sheet_with_fin(double height) {
  Sheets sheets;
  sheets.add(4, 1, 0, 1);
  const Index a = 6 * 5 + 1, b = 6 * 5 + 2;  // of the seventh column
  sheets.complex.triangles.push_back({a, b, sheets.complex.size()});
  const Point middle = 0.5 * (sheets.complex.balls[a].center + sheets.complex.balls[b].center);
  sheets.complex.balls.push_back(ball_of(middle + Vector(0, 0, height), 0.5));
  sheets.complex.complete();
  return std::move(sheets.complex);
}

TEST(DropFlakes, TakesWhatOneEdgeJoinsAndIsSmall) {
  detail::BallComplex complex = sheet_with_fin(1.5);
  const std::size_t triangles = complex.triangles.size();
  EXPECT_EQ(detail::drop_flakes(complex), 1u);
  EXPECT_EQ(complex.triangles.size(), triangles - 1);
  EXPECT_EQ(topology(complex.mesh()), (Topology{1, 0, 0}));
  for (const auto& edge : complex.edges) {
    const auto has = [&](const auto& t) {
      return std::count(t.begin(), t.end(), edge[0]) + std::count(t.begin(), t.end(), edge[1]) == 2;
    };
    EXPECT_TRUE(std::any_of(complex.triangles.begin(), complex.triangles.end(), has)) << "an edge was left bare";
  }
  EXPECT_EQ(detail::drop_flakes(complex), 0u);
}

TEST(DropFlakes, LeavesWhatIsLargeOrCloses) {
  detail::BallComplex large = sheet_with_fin(2.5);
  EXPECT_EQ(detail::drop_flakes(large), 0u);
  // Three more triangles close the fin to a hollow tetrahedron, whose base is the sheet's.
  detail::BallComplex hollow = sheet_with_fin(1.5);
  const Index a = 6 * 5 + 1, b = 6 * 5 + 2, c = 7 * 5 + 1, top = hollow.size() - 1;
  hollow.triangles.push_back({a, c, top});
  hollow.triangles.push_back({b, c, top});
  hollow.complete();
  ASSERT_EQ(topology(hollow.mesh()), (Topology{1, 0, 1}));
  EXPECT_EQ(detail::drop_flakes(hollow), 0u);
}

}  // namespace
}  // namespace orchard
