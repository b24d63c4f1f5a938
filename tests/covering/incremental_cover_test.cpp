#include "orchard/covering/incremental_cover.h"

#include <gtest/gtest.h>

#include <numeric>

#include "orchard/covering/coverage.h"
#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr double kSlack = 0.03;  // of radii: little, so that many changes uncover something

// A root, balls around clumps of triangles, and a ball around each triangle below its clump.
std::vector<PathBall> clumps(const Surface& surface, Index clump_size, double slack) {
  const auto count = static_cast<Index>(surface.mesh().triangles.size());
  const auto ball_around = [](const std::vector<Point>& points) {
    Point middle = Point::Zero();
    for (const Point& p : points) middle += p / static_cast<double>(points.size());
    double radius = 0;
    for (const Point& p : points) radius = std::max(radius, (p - middle).norm());
    return Sphere{middle, radius};
  };
  std::vector<PathBall> balls{{surface.bounding_ball().center, 1.01 * surface.bounding_radius(), kNone, false}};
  std::vector<PathBall> leaves;
  for (Index begin = 0; begin < count; begin += clump_size) {
    std::vector<Point> points;
    for (Index i = begin; i < std::min(count, begin + clump_size); ++i) {
      const auto corners = surface.corners(i);
      points.insert(points.end(), corners.begin(), corners.end());
      const Sphere leaf = ball_around({corners.begin(), corners.end()});
      leaves.push_back({leaf.center, leaf.radius * (1 + slack), static_cast<Index>(balls.size()), true});
    }
    const Sphere clump = ball_around(points);
    balls.push_back({clump.center, clump.radius * (1 + slack), 0, false});
  }
  balls.insert(balls.end(), leaves.begin(), leaves.end());
  return balls;
}

std::vector<Index> recomputed(const Surface& surface, std::span<const PathBall> balls) {
  std::vector<Index> triangles;
  for (const UncoveredTriangle& u : surface_coverage(surface, balls).uncovered) triangles.push_back(u.triangle);
  return triangles;
}

Sphere random_edit(Random& random, const PathBall& ball) {
  const Vector step(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  return {ball.center + 0.3 * ball.radius * step, ball.radius * random.uniform(0.3, 1.2)};
}

TEST(IncrementalCover, EqualsTheFullRecomputationAfterEveryOfManyRandomEdits) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Surface surface(seed % 2 == 0 ? test::torus(16, 8) : test::l_shape());
    IncrementalCover cover(surface, clumps(surface, 6, kSlack));
    Random random(seed, 1);
    for (int edit = 0; edit < 150; ++edit) {
      const auto ball = static_cast<Index>(random.below(cover.balls().size()));
      cover.change(ball, random_edit(random, cover.balls()[ball]));
      ASSERT_EQ(cover.uncovered(), recomputed(surface, cover.balls())) << "seed " << seed << ", edit " << edit;
    }
    EXPECT_GT(cover.uncovered_count(), 0u);
  }
}

TEST(IncrementalCover, TakesOnlyChangesThatLeaveEverythingCovered) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Surface surface(test::torus(16, 8));
    IncrementalCover cover(surface, clumps(surface, 6, kSlack));
    ASSERT_TRUE(cover.complete());
    Random random(seed, 2);
    int taken = 0, refused = 0;
    for (int edit = 0; edit < 200; ++edit) {
      const auto ball = static_cast<Index>(random.below(cover.balls().size()));
      const PathBall before = cover.balls()[ball];
      const Sphere wanted = random_edit(random, before);
      std::vector<PathBall> changed(cover.balls().begin(), cover.balls().end());
      changed[ball].center = wanted.center;
      changed[ball].radius = wanted.radius;
      const bool done = cover.try_change(ball, wanted);
      ASSERT_EQ(done, recomputed(surface, changed).empty()) << "seed " << seed << ", edit " << edit;
      ASSERT_EQ(cover.balls()[ball].radius, done ? wanted.radius : before.radius);
      ++(done ? taken : refused);
    }
    EXPECT_TRUE(recomputed(surface, cover.balls()).empty());
    EXPECT_GT(taken, 10);
    EXPECT_GT(refused, 10);
  }
}

TEST(IncrementalCover, ChecksOnlyTrianglesThatAChangeConcerns) {
  const Surface surface(test::torus(40, 20));
  IncrementalCover cover(surface, clumps(surface, 6, kSlack));
  const std::uint64_t all = cover.triangles_checked();
  EXPECT_EQ(all, surface.mesh().triangles.size());
  const auto leaf = static_cast<Index>(cover.balls().size() - 1);
  cover.change(leaf, {cover.balls()[leaf].center, 1.01 * cover.balls()[leaf].radius});
  EXPECT_LT(cover.triangles_checked() - all, 20u);
}

TEST(IncrementalCover, LooksAtTheGivenTrianglesAlone) {
  const Surface surface(test::torus(16, 8));
  IncrementalCover cover(surface, std::vector<Index>{5, 3}, clumps(surface, 6, kSlack));
  EXPECT_TRUE(cover.complete());
  cover.change(0, {Point(100, 0, 0), 1});
  EXPECT_EQ(cover.uncovered(), (std::vector<Index>{3, 5}));
}

}  // namespace
}  // namespace orchard
