#include "axis/coalesce.h"

#include <gtest/gtest.h>

#include "orchard/geometry/random.h"

namespace orchard::detail {
namespace {

std::vector<Index> brute_force(const std::vector<Point>& points, double distance) {
  std::vector<Index> lowest(points.size());
  for (Index i = 0; i < lowest.size(); ++i) lowest[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (Index i = 0; i < lowest.size(); ++i) {
      for (Index k = 0; k < lowest.size(); ++k) {
        if (lowest[k] >= lowest[i] || (points[i] - points[k]).squaredNorm() > distance * distance) continue;
        lowest[i] = lowest[k];
        changed = true;
      }
    }
  }
  return lowest;
}

TEST(Coalesce, AgreesWithBruteForceOnClumpsChainsAndStrays) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 1);
    const double distance = 1e-3;
    std::vector<Point> points;
    while (points.size() < 300) {
      const bool stray = points.empty() || random.uniform() < 0.3;
      const Point base = stray ? Point::Zero() : points[random.below(points.size())];
      const double reach = stray ? 1.0 : 2 * distance;
      points.push_back(base + reach * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    }
    EXPECT_EQ(representatives_of_coincident(points, distance), brute_force(points, distance));
  }
}

TEST(Coalesce, FindsPartnersAcrossTheBordersOfItsCells) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Point> points{Point::Zero()};
    for (int k = 1; k < 200; ++k) {  // pairs at every phase of a cell's width
      Point first = Point::Constant(7.0 * k), second = first;
      first[axis] += 0.33 * k;
      second[axis] = first[axis] + 0.9e-2;
      points.push_back(first);
      points.push_back(second);
    }
    const std::vector<Index> lowest = representatives_of_coincident(points, 1e-2);
    for (Index i = 1; i + 1 < points.size(); i += 2) {
      EXPECT_EQ(lowest[i], i);
      EXPECT_EQ(lowest[i + 1], i);
    }
  }
}

TEST(Coalesce, AcceptsNothingAndOnePoint) {
  EXPECT_TRUE(representatives_of_coincident({}, 1).empty());
  const std::vector<Point> one{{1, 2, 3}};
  EXPECT_EQ(representatives_of_coincident(one, 1), std::vector<Index>{0});
}

}  // namespace
}  // namespace orchard::detail
