#include "orchard/covering/planar_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "plane_edges.h"

namespace orchard {
namespace {

using Region = std::vector<PlanePoint>;

const Region kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const Region kL{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

bool covered(const Region& region, const std::vector<PlanarShape>& shapes) {
  return cover_of_polygon(region, shapes).covered;
}

PlanarShape rectangle(double x0, double y0, double x1, double y1) { return PlanarShape::rectangle({x0, y0}, {x1, y1}); }

bool holds(const PlanarShape& shape, const PlanePoint& p) {
  if (shape.corners.empty()) return (p - shape.center).norm() <= shape.radius;
  int left = 0, right = 0;
  for (const detail::Edge& edge : detail::edges_of(shape.corners)) {
    left += edge.side_of(p) >= 0;
    right += edge.side_of(p) <= 0;
  }
  return std::max(left, right) == static_cast<int>(shape.corners.size());
}

// A random convex polygon: points of an ellipse in order.
PlanarShape random_polygon(Random& random, const PlanePoint& center, double size) {
  const int corners = 3 + static_cast<int>(random.below(5));
  const double turn = random.uniform(0, 6.28), flat = random.uniform(0.4, 1);
  std::vector<PlanePoint> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = turn + (i + random.uniform(0, 0.6)) * 6.283185 / corners;
    points.push_back(center + size * PlanePoint(std::cos(angle), flat * std::sin(angle)));
  }
  return PlanarShape::polygon(points);
}

std::vector<PlanarShape> random_shapes(Random& random) {
  std::vector<PlanarShape> shapes;
  const auto count = 3 + random.below(25);
  for (std::uint64_t i = 0; i < count; ++i) {
    const PlanePoint center(random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1));
    const double size = random.uniform(0.1, 0.6);
    const auto kind = random.below(3);
    if (kind == 0) shapes.push_back(PlanarShape::disk(center, size));
    if (kind == 1) shapes.push_back(rectangle(center.x(), center.y(), center.x() + size, center.y() + size / 2));
    if (kind == 2) shapes.push_back(random_polygon(random, center, size));
  }
  return shapes;
}

bool some_shape_holds(const std::vector<PlanarShape>& shapes, const PlanePoint& p) {
  return std::any_of(shapes.begin(), shapes.end(), [&](const PlanarShape& s) { return holds(s, p); });
}

TEST(PlanarCover, NeverCallsARegionCoveredThatHasAnUncoveredPoint) {
  std::uint64_t points = 0;
  for (std::uint64_t seed = 0; points < 300'000; ++seed) {
    Random random(seed, 1);
    const auto shapes = random_shapes(random);
    if (!covered(kSquare, shapes)) continue;
    for (int i = 0; i < 2000; ++i)
      ASSERT_TRUE(some_shape_holds(shapes, {random.uniform(), random.uniform()})) << "seed " << seed;
    points += 2000;
  }
}

// Beside a gap that is reported there is an uncovered point of the region.
TEST(PlanarCover, IsRightWhereItSaysThatSomethingIsUncovered) {
  int checked = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random random(seed, 1);
    const auto shapes = random_shapes(random);
    const PlanarCover cover = cover_of_polygon(kSquare, shapes);
    bool found = cover.covered || cover.gaps.empty();
    for (const PlanarGap& gap : cover.gaps)
      for (int i = 0; i < 16 && !found; ++i) {
        const PlanePoint p = gap.middle + 1e-9 * PlanePoint(std::cos(0.4 * i), std::sin(0.4 * i));
        found = holds(PlanarShape::polygon(kSquare), p) && !some_shape_holds(shapes, p);
      }
    EXPECT_TRUE(found) << "seed " << seed;
    checked += !cover.covered;
  }
  EXPECT_GT(checked, 100);
}

TEST(PlanarCover, TilesThatAbutLeaveNoGap) {
  EXPECT_TRUE(covered(kSquare, {rectangle(0, 0, 1, 1)}));
  EXPECT_TRUE(covered(kSquare, {rectangle(0, 0, 0.3, 1), rectangle(0.3, 0, 1, 1)}));
  // Bricks: corners on sides; thirds are no binary fractions.
  std::vector<PlanarShape> bricks;
  for (int row = 0; row < 3; ++row)
    for (int column = -1; column < 4; ++column) {
      const double shift = row % 2 == 0 ? 0 : 1.0 / 6;
      bricks.push_back(rectangle(column / 3.0 + shift, row / 3.0, (column + 1) / 3.0 + shift, (row + 1) / 3.0));
    }
  // Neighbours' sides must be the very same numbers.
  const double x = 1 / 3.0, y = 0.1 + 0.2;
  EXPECT_TRUE(covered(
      kSquare, {rectangle(0, 0, x, y), rectangle(x, 0, 1, y), rectangle(0, y, 0.7, 1), rectangle(0.7, y, 1, 1)}));
  EXPECT_FALSE(covered(kSquare, {rectangle(0, 0, x, y), rectangle(x, 0, 1, y), rectangle(0, y, 0.7, 1),
                                 rectangle(0.7, std::nextafter(y, 1), 1, 1)}));
  for (std::size_t lost = 0; lost < bricks.size(); ++lost) {
    auto rest = bricks;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(lost));
    const bool needed = bricks[lost].corners[1].x() > 0.01 && bricks[lost].corners[0].x() < 0.99;
    EXPECT_TRUE(!needed || !covered(kSquare, rest)) << lost;
  }
}

// A fan of triangles around an inner point, cut by another polygon's sides.
TEST(PlanarCover, ATriangulationOfTheRegionCoversIt) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 2);
    const PlanePoint middle(random.uniform(0.2, 0.8), random.uniform(0.2, 0.8));
    std::vector<PlanarShape> fan;
    for (std::size_t i = 0; i < 4; ++i) fan.push_back(PlanarShape::polygon({kSquare[i], kSquare[(i + 1) % 4], middle}));
    EXPECT_TRUE(covered(kSquare, fan)) << "seed " << seed;
    fan.push_back(random_polygon(random, {random.uniform(), random.uniform()}, 0.5));
    fan.push_back(PlanarShape::disk({random.uniform(), random.uniform()}, random.uniform(0.1, 0.6)));
    EXPECT_TRUE(covered(kSquare, fan)) << "seed " << seed << ", with more on top";
    fan.erase(fan.begin() + static_cast<std::ptrdiff_t>(random.below(4)));
    if (covered(kSquare, fan)) {
      for (int i = 0; i < 2000; ++i) {
        const PlanePoint p(random.uniform(), random.uniform());
        ASSERT_TRUE(std::any_of(fan.begin(), fan.end(), [&](const auto& s) { return holds(s, p); })) << seed;
      }
    }
  }
}

TEST(PlanarCover, EdgesThatAbutOnTheSameSideAreNoCover) {
  const PlanarShape half = rectangle(0, 0, 0.5, 1);
  EXPECT_FALSE(covered(kSquare, {half, half}));
  EXPECT_FALSE(covered(kSquare, {half, rectangle(0.2, 0, 0.5, 1)}));
  EXPECT_FALSE(covered(kSquare, {PlanarShape::disk({0.5, 0.5}, 0.6), PlanarShape::disk({0.5, 0.5}, 0.6)}));
}

TEST(PlanarCover, AGapBetweenTwoEdgesOnOneLineIsSeen) {
  // Below, one rectangle; above, two with a slot between them.
  const std::vector<PlanarShape> shapes{rectangle(0, 0, 1, 0.5), rectangle(0, 0.5, 0.4, 1), rectangle(0.5, 0.5, 1, 1)};
  const PlanarCover cover = cover_of_polygon(kSquare, shapes);
  EXPECT_FALSE(cover.covered);
  ASSERT_FALSE(cover.gaps.empty());
  EXPECT_EQ(cover.gaps[0].shape, 0u);
  EXPECT_NEAR(cover.gaps[0].middle.x(), 0.45, 1e-9);
  auto filled = shapes;
  filled.push_back(rectangle(0.4, 0.5, 0.5, 1));
  EXPECT_TRUE(covered(kSquare, filled));
}

TEST(PlanarCover, DisksRectanglesAndPolygonsTogether) {
  const std::vector<PlanarShape> shapes{PlanarShape::disk({0.5, 0.5}, 0.65), rectangle(-0.1, -0.1, 0.2, 0.2),
                                        rectangle(0.8, 0.8, 1.1, 1.1),
                                        PlanarShape::polygon({{0.7, -0.1}, {1.2, -0.1}, {1.2, 0.4}}),
                                        PlanarShape::polygon({{-0.1, 0.6}, {0.4, 1.1}, {-0.1, 1.1}})};
  EXPECT_TRUE(covered(kSquare, shapes));
  for (std::size_t lost = 0; lost < shapes.size(); ++lost) {
    auto rest = shapes;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(lost));
    EXPECT_FALSE(covered(kSquare, rest)) << lost;
  }
}

TEST(PlanarCover, TakesRegionsThatAreNotConvexEitherWayRound) {
  Region clockwise(kL.rbegin(), kL.rend());
  for (const Region& region : {kL, clockwise}) {
    EXPECT_TRUE(covered(region, {rectangle(0, 0, 2, 1), rectangle(0, 1, 1, 2)}));
    EXPECT_TRUE(covered(region, {PlanarShape::disk({1, 1}, 1.5)}));
    EXPECT_FALSE(covered(region, {rectangle(0, 0, 2, 1), rectangle(0, 1, 1, 1.99)}));
    EXPECT_FALSE(covered(region, {rectangle(0, 0, 2, 1)}));
    EXPECT_FALSE(covered(region, {}));
  }
}

TEST(PlanarCover, RefusesWhatIsNoRegionOrNoShape) {
  EXPECT_THROW(covered({{0, 0}, {1, 1}}, {}), InputError);
  EXPECT_THROW(covered({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {}), InputError);
  EXPECT_THROW(covered({{0, 0}, {1, 0}, {2, 0}}, {}), InputError);
  EXPECT_THROW(covered(kSquare, {PlanarShape::polygon(kL)}), InputError);
  EXPECT_THROW(covered(kSquare, {PlanarShape::disk({0, 0}, 0)}), InputError);
  EXPECT_THROW(covered(kSquare, {PlanarShape::disk({0, NAN}, 1)}), InputError);
}

TEST(PlanarCover, IsTheSameMirroredAndScaledByPowersOfTwo) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 3);
    const auto shapes = random_shapes(random);
    const bool answer = covered(kSquare, shapes);
    for (const double scale : {0x1p-20, 0x1p+20}) {
      Region region = kSquare;
      for (PlanePoint& p : region) p = {scale * p.y(), scale * p.x()};
      auto copy = shapes;
      for (PlanarShape& s : copy) {
        for (PlanePoint& p : s.corners) p = {scale * p.y(), scale * p.x()};
        s.center = {scale * s.center.y(), scale * s.center.x()};
        s.radius *= scale;
      }
      EXPECT_EQ(covered(region, copy), answer) << "seed " << seed;
    }
  }
}

TEST(ExactOrientation, TellsPointsOnALineFromPointsBesideIt) {
  const PlanePoint a(0.1, 0.1), b(0.3, 0.3);
  EXPECT_EQ(detail::exact_orientation(a, b, {0.2, 0.2}), 0);
  EXPECT_EQ(detail::exact_orientation(a, b, {0.2, std::nextafter(0.2, 1)}), 1);
  EXPECT_EQ(detail::exact_orientation(a, b, {0.2, std::nextafter(0.2, 0)}), -1);
  EXPECT_EQ(detail::exact_orientation({1e6, 1}, {-1e6, -1}, {1e-300, 0}), 1);
}

}  // namespace
}  // namespace orchard
