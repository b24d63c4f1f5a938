#include "orchard/geometry/spatial_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "orchard/geometry/random.h"

namespace orchard {
namespace {

std::vector<Point> random_points(std::uint64_t seed, Index count) {
  std::vector<Point> points;
  for (Index i = 0; i < count; ++i) {
    Random random(seed, i);
    points.emplace_back(random.uniform(), random.uniform(), random.uniform());
  }
  return points;
}

double length_in(const std::vector<Point>& points, const std::vector<std::size_t>& order) {
  double length = 0;
  for (std::size_t i = 1; i < order.size(); ++i) length += (points[order[i]] - points[order[i - 1]]).norm();
  return length;
}

TEST(SpatialOrder, HasEachPointOnceAndIsShort) {
  for (const Index count : {1000u, 8000u}) {
    const std::vector<Point> points = random_points(3, count);
    std::vector<std::size_t> order = spatial_order(points);
    // The shortest order is about 0.7 n^(2/3) long, and that of a Hilbert curve less than twice that; a random one 0.66
    // n.
    EXPECT_LT(length_in(points, order), 1.4 * std::pow(count, 2.0 / 3));
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> all(count);
    std::iota(all.begin(), all.end(), std::size_t{0});
    EXPECT_EQ(order, all);
  }
}

TEST(SpatialOrder, TakesNoneOneAndEqualPoints) {
  EXPECT_TRUE(spatial_order({}).empty());
  EXPECT_EQ(spatial_order(std::vector<Point>{{1, 2, 3}}), std::vector<std::size_t>{0});
  EXPECT_EQ(spatial_order(std::vector<Point>(100, Point(1, 2, 3))).size(), 100u);
}

}  // namespace
}  // namespace orchard
