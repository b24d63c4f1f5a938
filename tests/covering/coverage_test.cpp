#include "orchard/covering/coverage.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard {
namespace {

// A ball around each triangle's corners below one root.
std::vector<PathBall> ball_per_triangle(const Surface& surface, double slack) {
  std::vector<PathBall> balls{{surface.bounding_ball().center, surface.bounding_radius() * 1.001, kNone, false}};
  for (Index i = 0; i < surface.mesh().triangles.size(); ++i) {
    const auto c = surface.corners(i);
    const Point middle = (c[0] + c[1] + c[2]) / 3;
    double radius = 0;
    for (const Point& p : c) radius = std::max(radius, (p - middle).norm());
    balls.push_back({middle, radius * (1 + slack), 0, true});
  }
  return balls;
}

TEST(Coverage, CertifiesASurfaceWhoseEveryTriangleHasItsBall) {
  const Surface surface(test::torus(40, 20));
  EXPECT_TRUE(surface_coverage(surface, ball_per_triangle(surface, 1e-9)).complete());
}

TEST(Coverage, NamesTheTrianglesAroundThoseThatLostTheirBalls) {
  const Surface surface(test::icosphere(2));
  const Index lost = 17;
  std::vector<Index> shrunk{lost};
  for (Index neighbor : surface.neighbors(lost)) shrunk.push_back(neighbor);
  auto balls = ball_per_triangle(surface, 1e-9);
  for (Index triangle : shrunk) balls[triangle + 1].radius *= 0.3;  // the root is ball 0
  std::vector<Index> uncovered;
  for (const UncoveredTriangle& u : surface_coverage(surface, balls).uncovered) uncovered.push_back(u.triangle);
  EXPECT_TRUE(std::find(uncovered.begin(), uncovered.end(), lost) != uncovered.end());
  for (Index triangle : uncovered)
    EXPECT_TRUE(std::find(shrunk.begin(), shrunk.end(), triangle) != shrunk.end()) << triangle;
  const std::vector<Index> some{3, lost, 40};
  EXPECT_EQ(surface_coverage(surface, some, balls).uncovered.size(), 1u);
}

TEST(Coverage, DoesNotDependOnTheThreadCount) {
  const Surface surface(test::torus(60, 30));
  auto balls = ball_per_triangle(surface, 1e-9);
  Random random(7, 7);
  for (PathBall& ball : balls) ball.radius *= random.uniform(0.6, 1.3);
  std::vector<std::vector<Index>> results;
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<Index> found;
    for (const auto& u : surface_coverage(surface, balls).uncovered) {
      found.push_back(u.triangle);
      for (const auto& arc : u.cover.arcs) found.push_back(arc.ball);
    }
    results.push_back(found);
  }
  EXPECT_FALSE(results[0].empty());
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace orchard
