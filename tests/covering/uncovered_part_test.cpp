#include "orchard/covering/uncovered_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "support.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using namespace test;

std::vector<Index> all_triangles(const Surface& surface) {
  std::vector<Index> all(surface.mesh().triangles.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

TEST(UncoveredPart, OfATriangleWithADiskInIt) {
  const Surface surface(TriangleMesh{{Point(0, 0, 0), Point(4, 0, 0), Point(0, 4, 0)}, {{0, 1, 2}}});
  const PathForest forest(leaves({{Point(1, 1, 0), 0.5}}));
  const UncoveredPart part = uncovered_part(surface, all_triangles(surface), forest);
  const double area = 8 - 0.25 * 3.14159265358979, distance = std::sqrt(10.0) - 0.5;
  EXPECT_LE(part.area.lower, area);
  EXPECT_GE(part.area.upper, area);
  EXPECT_LE(part.area.upper - part.area.lower, 0.03 * area);
  EXPECT_NEAR(part.distance.lower, distance, 0.02 * distance);
  EXPECT_GE(part.distance.upper, distance);
  EXPECT_NEAR(forest.distance(part.farthest), part.distance.lower, 1e-12);
}

TEST(UncoveredPart, BracketsWhatSamplesFind) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed, 1);
    const Triangle t = random_triangle(random);
    const Surface surface(TriangleMesh{{t[0], t[1], t[2]}, {{0, 1, 2}}});
    const auto balls = random_forest(random, t, 0.5 * (t[1] - t[0]).norm());
    const UncoveredPart part = uncovered_part(surface, all_triangles(surface), PathForest(balls));
    const int samples = 20000;
    int outside = 0;
    double farthest = 0;
    for (int i = 0; i < samples; ++i) {
      const double distance = path_distance(point_of(t, random.uniform(), random.uniform()), balls);
      outside += distance > 0;
      farthest = std::max(farthest, distance);
    }
    const double share = static_cast<double>(outside) / samples, noise = 4 * std::sqrt(share / samples) + 4.0 / samples;
    EXPECT_LE(part.area.lower / surface.area(0), share + noise) << "seed " << seed;
    EXPECT_GE(part.area.upper / surface.area(0), share - noise) << "seed " << seed;
    EXPECT_NEAR(part.likely_area / surface.area(0), share, noise + 0.01 * share) << "seed " << seed;
    EXPECT_LE(part.area.upper - part.area.lower, 0.02 * part.area.upper + 1e-12) << "seed " << seed;
    EXPECT_GE(part.distance.upper, farthest) << "seed " << seed;
    EXPECT_LE(part.distance.lower, part.distance.upper) << "seed " << seed;
  }
}

TEST(UncoveredPart, IsNothingWhereEverythingIsCovered) {
  const Surface surface(icosphere(2));
  const PathForest forest(leaves({{Point::Zero(), 1.1}}));
  const UncoveredPart part = uncovered_part(surface, all_triangles(surface), forest);
  EXPECT_EQ(part.area.upper, 0);
  EXPECT_EQ(part.distance.upper, 0);
}

TEST(PathForest, DepthIsPathDepth) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 2);
    const Triangle t = random_triangle(random);
    const auto balls = random_forest(random, t, 0.5);
    const PathForest forest(balls);
    for (int i = 0; i < 20; ++i) {
      const Point p = random_vector(random, 2);
      EXPECT_EQ(forest.distance(p), path_distance(p, balls)) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace orchard
