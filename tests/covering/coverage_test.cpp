#include "orchard/covering/coverage.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "orchard/covering/path_forest.h"
#include "orchard/geometry/random.h"
#include "support.h"
#include "support/effort.h"
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

TEST(PathForest, TellsWhetherAPathComesWithinADistance) {
  for (std::uint64_t k = 0; k < 100 * test::more(); ++k) {
    Random random(test::first_seed() + k, 33);
    const test::Triangle triangle = test::random_triangle(random);
    const PathForest forest(test::random_forest(random, triangle, random.uniform(0.1, 1)));
    for (int i = 0; i < 50; ++i) {
      const Point point = test::random_vector(random, 2);
      const double distance = forest.distance(point);
      EXPECT_TRUE(forest.within(point, distance)) << "seed " << k;
      EXPECT_FALSE(forest.within(point, distance - 1e-12)) << "seed " << k;
    }
  }
}

// A point of the part is in a path of the balls gathered where it is in any.
TEST(PathForest, GathersWhatHoldsAPartOfATriangle) {
  std::size_t all = 0, some = 0, inside = 0;
  for (std::uint64_t k = 0; k < 200 * test::more(); ++k) {
    Random random(test::first_seed() + k, 34);
    const test::Triangle triangle = test::random_triangle(random);
    const PathForest forest(test::random_forest(random, triangle, random.uniform(0.1, 1)));
    const Sphere where{test::point_of(triangle, random.uniform(), random.uniform()), random.uniform(0.05, 0.5)};
    NearBalls whole, part;
    forest.gather(triangle, whole);
    forest.gather(triangle, where, part);
    all += whole.balls.size();
    some += part.balls.size();
    for (int i = 0; i < 100; ++i) {
      const Point point = test::point_of(triangle, random.uniform(), random.uniform());
      if ((point - where.center).norm() > where.radius) continue;
      ++inside;
      EXPECT_EQ(path_distance(point, whole.balls) <= 0, path_distance(point, part.balls) <= 0) << "seed " << k;
    }
  }
  EXPECT_LT(some, all);
  EXPECT_GT(inside, 1000u);
}

// Whether all corners lie in all balls from some leaf up, with so much room in parts of the radius.
bool some_path_holds(std::span<const PathBall> balls, const Box& box, double room) {
  const auto holds = [&](const PathBall& ball) {
    for (int corner = 0; corner < 8; ++corner) {
      const Point at = box.corner(static_cast<Box::CornerType>(corner));
      if (!((at - ball.center).norm() <= ball.radius * (1 - room))) return false;
    }
    return true;
  };
  for (Index leaf = 0; leaf < balls.size(); ++leaf) {
    if (!balls[leaf].leaf) continue;
    Index up = leaf;
    while (up != kNone && holds(balls[up])) up = balls[up].parent;
    if (up == kNone) return true;
  }
  return false;
}

TEST(HoldingPath, HoldsBoxesThatLieInAllBallsOfAPathAndNoOthers) {
  Index held = 0, open = 0;
  for (std::uint64_t k = 0; k < 200 * test::more(); ++k) {
    Random random(test::first_seed() + k, 31);
    const test::Triangle triangle = test::random_triangle(random);
    const std::vector<PathBall> balls = test::random_forest(random, triangle, random.uniform(0.3, 2));
    const PathForest forest(balls);
    HoldingPath path(forest);
    for (int i = 0; i < 50; ++i) {
      const Point middle = test::point_of(triangle, random.uniform(), random.uniform());
      const Vector half = test::random_vector(random, 0.3 * random.uniform()).cwiseAbs();
      const Box box(middle - half, middle + half);
      const bool holds = path.holds(box);
      ++(holds ? held : open);
      EXPECT_TRUE(!holds || some_path_holds(balls, box, 0)) << "seed " << k;
      EXPECT_TRUE(holds || !some_path_holds(balls, box, 1e-9)) << "seed " << k;
    }
  }
  EXPECT_GT(held, 100u);
  EXPECT_GT(open, 100u);
}

// What is left out of a check because a path holds a box around it would have been found to be covered.
TEST(HoldingPath, LeavesOutOnlyTrianglesThatAreCovered) {
  const Surface surface(test::torus(60, 30));
  Index left_out = 0;
  for (std::uint64_t k = 0; k < 10 * test::more(); ++k) {
    Random random(test::first_seed() + k, 32);
    std::vector<PathBall> balls{{surface.bounding_ball().center, surface.bounding_radius() * 1.1, kNone, false}};
    for (int i = 0; i < 60; ++i) {
      const auto corners = surface.corners(static_cast<Index>(random.below(surface.mesh().triangles.size())));
      balls.push_back({corners[0], surface.bounding_radius() * random.uniform(0.05, 0.5), 0, true});
    }
    const PathForest forest(balls);
    HoldingPath path(forest);
    std::vector<Index> to_check;
    surface.triangles_near(
        surface.bounding_ball(), [&](const Box& box) { return path.holds(box); }, to_check);
    left_out += static_cast<Index>(surface.mesh().triangles.size() - to_check.size());
    const auto names = [](const Coverage& coverage) {
      std::vector<Index> triangles;
      for (const UncoveredTriangle& u : coverage.uncovered) triangles.push_back(u.triangle);
      return triangles;
    };
    EXPECT_EQ(names(surface_coverage(surface, to_check, balls)), names(surface_coverage(surface, balls)));
  }
  EXPECT_GT(left_out, 1000u);
}

}  // namespace
}  // namespace orchard
