// Sheets of refined axes at corners of solids in which blunt edges meet sharper ones.
#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "extend/extend_sheets.h"
#include "features/feature_edges.h"
#include "known_axes.h"
#include "reach/on_sheet.h"
#include "skeletons.h"
#include "support/shapes.h"

namespace orchard {
namespace {

// The length of the borders that do not lie on the surface.
double length_of_inner_borders(const MedialMesh& axis) {
  std::map<std::pair<Index, Index>, int> triangles;
  for (const auto& [a, b, c] : axis.triangles) {
    for (const auto& [p, q] : {std::minmax(a, b), std::minmax(b, c), std::minmax(a, c)}) ++triangles[{p, q}];
  }
  double length = 0;
  for (const auto& [edge, count] : triangles) {
    const auto [a, b] = edge;
    if (count == 1 && (axis.radii[a] > 0 || axis.radii[b] > 0)) length += (axis.centers[a] - axis.centers[b]).norm();
  }
  return length;
}

TEST(CornerSheets, OfPrismsAndTheirLikeHaveNoBordersWithinTheSolid) {
  // Every sheet of these axes ends on edges of the solid and where it meets others.
  for (const auto& [top, sides] : {std::pair{1.0, 8}, {1.0, 12}, {0.4, 8}}) {
    const Surface solid(test::turned({{1, 0}, {top, 4}}, sides));
    EXPECT_EQ(length_of_inner_borders(test::refined_axis(solid, 5000)), 0) << top << " " << sides;
  }
}

TEST(OnSheet, ATriangleWithinASheetIsAndOneBeyondItsBorderIsNot) {
  const test::KnownAxis box = test::known_box({1, 2, 4});
  const Surface solid(box.solid);
  const Point p(0.5, 0.6, 1.2), q(0.5, 0.9, 1.4);  // of the rectangle in the middle
  EXPECT_TRUE(detail::lies_on_sheet(solid, detail::Reconstruction(box.axis), p, q, Point(0.5, 1.1, 2)));
  MedialMesh part;  // of the same rectangle
  part.centers = {p, q, Point(0.5, 1.2, 1)};
  part.radii = {0.5, 0.5, 0.5};
  part.triangles = {{0, 1, 2}};
  complete(part);
  const detail::Reconstruction less(part);
  EXPECT_FALSE(detail::lies_on_sheet(solid, less, p, q, Point(0.5, 0.6, 2)));
  EXPECT_TRUE(detail::lies_on_sheet(solid, less, p, q, Point(0.5, 1.1, 1.1)));
}

// The pyramid over the middle of a corner of a cube: a triangle that passes the corner between places on two edges, and
// a vertex on the third.
TEST(CornerSheets, BordersThatPassACornerAreDividedThere) {
  const Surface cube(test::box(Point(0, 0, 0), Point(1, 1, 1)));
  const detail::FeatureEdges features(cube, {.min_loss = 1e-3, .min_length = 0.2});
  detail::BallComplex complex;
  const auto add = [&](const Point& center, double radius) {
    detail::ExactBall ball;
    ball.center = center;
    ball.radius = radius;
    ball.exact = true;
    complex.balls.push_back(ball);
  };
  add(Point(0.2, 0.2, 0.2), 0.2);
  add(Point(0.1, 0, 0), 0);
  add(Point(0, 0.1, 0), 0);
  add(Point(0, 0, 0.2), 0);
  complex.edges = {{0, 3}};
  complex.triangles = {{0, 1, 2}};
  complex.complete();
  const detail::BorderOptions options{
      .level = 1e-3, .tolerance = 1e-3, .spacing = 0.1, .merging = 1e-4, .features = &features};
  EXPECT_EQ(detail::divide_at_corners(cube, complex, options), 1u);
  ASSERT_EQ(complex.size(), 5u);
  EXPECT_EQ(complex.balls[4].center, Point(0, 0, 0));
  EXPECT_EQ(complex.balls[4].radius, 0);
  EXPECT_EQ(complex.triangles, (std::vector<std::array<Index, 3>>{{0, 1, 4}, {0, 2, 4}}));
  EXPECT_EQ(detail::divide_at_corners(cube, complex, options), 0u);  // there is a vertex now

  // Without the place on the third edge, no sheet has to end at the corner.
  complex.edges.clear();
  complex.triangles = {{0, 1, 2}};
  complex.complete();
  complex.balls.resize(3);
  EXPECT_EQ(detail::divide_at_corners(cube, complex, options), 0u);
}

}  // namespace
}  // namespace orchard
