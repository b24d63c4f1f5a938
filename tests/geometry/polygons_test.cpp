#include "io/polygons.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "orchard/geometry/random.h"

namespace orchard {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

Triangles split(const std::vector<Point>& polygon) {
  std::vector<Index> corners(polygon.size());
  std::iota(corners.begin(), corners.end(), Index{0});
  FaceCollector faces;
  faces.add(corners);
  return std::move(faces).finish(polygon).triangles;
}

// The smallest z of the triangles' normals, times twice their areas.
double min_area(const std::vector<Point>& polygon, const Triangles& triangles) {
  double min = INFINITY;
  for (const auto& [a, b, c] : triangles) {
    min = std::min(min, (polygon[b] - polygon[a]).cross(polygon[c] - polygon[a]).z());
  }
  return min;
}

TEST(Polygons, FanOutFromTheFirstCornerIfConvex) {
  EXPECT_EQ(split({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), (Triangles{{0, 1, 2}, {0, 2, 3}}));
  std::vector<Point> circle;
  for (int i = 0; i < 9; ++i) circle.emplace_back(std::cos(0.7 * i), std::sin(0.7 * i), 0.1 * std::cos(0.7 * i));
  EXPECT_EQ(split(circle)[3], (std::array<Index, 3>{0, 4, 5}));
}

TEST(Polygons, FanOutFromTheReflexCornerOfAConcaveQuadrilateral) {
  const std::vector<Point> dart{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5, 1, 0}};
  for (std::size_t turn = 0; turn < 4; ++turn) {
    std::vector<Point> turned;
    for (std::size_t i = 0; i < 4; ++i) turned.push_back(dart[(i + turn) % 4]);
    const Triangles triangles = split(turned);
    ASSERT_EQ(triangles.size(), 2u);
    EXPECT_GT(min_area(turned, triangles), 0) << turn;
  }
}

TEST(Polygons, AvoidDegenerateTrianglesWhereACornerLiesOnAnEdge) {
  const std::vector<Point> polygon{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const Triangles triangles = split(polygon);
  ASSERT_EQ(triangles.size(), 3u);
  EXPECT_GT(min_area(polygon, triangles), 0);
}

TEST(Polygons, KeepTheAreaOfStarShapedOnes) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    // Seen from its first corner the whole polygon is visible, but it is listed from another.
    Random random(seed, 1);
    const std::size_t n = 4 + random.below(8);
    std::vector<Point> star{{0, 0, 0}};
    for (std::size_t i = 1; i < n; ++i) {
      const double angle = 1.5 * static_cast<double>(i) / static_cast<double>(n), radius = random.uniform(0.3, 1);
      star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    const std::size_t turn = random.below(n);
    std::vector<Point> turned;
    for (std::size_t i = 0; i < n; ++i) turned.push_back(star[(i + turn) % n]);
    const Triangles triangles = split(turned);
    ASSERT_EQ(triangles.size(), n - 2) << seed;
    EXPECT_GT(min_area(turned, triangles), 0) << seed;
  }
}

TEST(Polygons, ScaleExactlyByPowersOfTwo) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed, 2);
    std::vector<Point> polygon, scaled;
    for (int i = 0; i < 6; ++i) polygon.emplace_back(random.uniform(), random.uniform(), random.uniform());
    for (const Point& point : polygon) scaled.push_back(point * 0x1p-40);
    EXPECT_EQ(split(polygon), split(scaled)) << seed;
  }
}

TEST(Polygons, KeepDegenerateOnes) {
  EXPECT_EQ(split({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}), (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(split({{0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}, {1e300, 1e300, 1e300}}).size(), 2u);
}

}  // namespace
}  // namespace orchard
