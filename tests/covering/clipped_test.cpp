#include <gtest/gtest.h>

#include <algorithm>

#include "orchard/covering/boundary_lemma.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

TEST(ClippedLemma, NeverCallsAPartCoveredThatHasAnUncoveredPoint) {
  std::uint64_t points = 0;
  int differ = 0;
  for (std::uint64_t seed = 0; points < 300'000; ++seed) {
    Random random(seed, 1);
    const Triangle t = random_triangle(random);
    const double size = (t[1] - t[0]).norm();
    const Sphere clip{point_of(t, random.uniform(), random.uniform()) + random_vector(random, 0.2 * size),
                      size * random.uniform(0.1, 0.7)};
    const auto balls = random_forest(random, t, size * random.uniform(0.3, 0.8));
    if (!cover_of_triangle(t, clip, balls).covered) continue;
    differ += !triangle_covered(t, balls);
    for (int i = 0; i < 1000; ++i) {
      const Point p = point_of(t, random.uniform(), random.uniform());
      if ((p - clip.center).norm() > clip.radius) continue;
      ASSERT_TRUE(in_some_path_region(p, balls)) << "seed " << seed;
      ++points;
    }
  }
  EXPECT_GT(differ, 50);  // where the rest of the triangle is not covered
}

TEST(ClippedLemma, FindsThePartCoveredWhereEveryBallCoversItWithRoomToSpare) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed, 2);
    const Triangle t = random_triangle(random);
    const Sphere clip{point_of(t, random.uniform(), random.uniform()) + random_vector(random, 0.2),
                      random.uniform(0.05, 0.5)};
    EXPECT_TRUE(cover_of_triangle(t, clip, leaves({{clip.center, clip.radius * (1 + 1e-9)}})).covered);
    // Two balls around opposite points of the clipping ball, each a little more than its half.
    const Vector step = 0.5 * clip.radius * random_vector(random).normalized();
    const auto halves = leaves({{clip.center + step, 1.2 * clip.radius}, {clip.center - step, 1.2 * clip.radius}});
    EXPECT_TRUE(cover_of_triangle(t, clip, halves).covered) << "seed " << seed;
  }
}

TEST(ClippedLemma, ABallAsLargeAsTheClippingOneIsTangentAndSoUncertain) {
  const Triangle t{Point(0, 0, 0), Point(4, 0, 0), Point(0, 4, 0)};
  const Sphere clip{Point(1, 1, 0.1), 0.5};
  EXPECT_FALSE(cover_of_triangle(t, clip, leaves({clip})).covered);
}

TEST(ClippedLemma, NothingIsLeftOfATriangleThatTheBallDoesNotTouch) {
  const Triangle t{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
  EXPECT_TRUE(cover_of_triangle(t, {Point(5, 5, 0), 1}, {}).covered);
  EXPECT_TRUE(cover_of_triangle(t, {Point(0.2, 0.2, 3), 1}, {}).covered);
  EXPECT_FALSE(cover_of_triangle(t, {Point(0.2, 0.2, 0), 0.1}, {}).covered);
}

TEST(ClippedLemma, IsThePlainLemmaWhereTheBallHoldsTheTriangle) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed, 3);
    const Triangle t = random_triangle(random);
    const auto balls = random_forest(random, t, random.uniform(0.4, 1) * (t[1] - t[0]).norm());
    EXPECT_EQ(cover_of_triangle(t, {Point::Zero(), 4}, balls).covered, triangle_covered(t, balls)) << "seed " << seed;
  }
}

TEST(ClippedLemma, NamesAWitnessInThePart) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed, 4);
    const Triangle t = random_triangle(random);
    const Sphere clip{point_of(t, random.uniform(), random.uniform()), random.uniform(0.1, 0.5)};
    const auto balls = random_forest(random, t, 0.3);
    const TriangleCover cover = cover_of_triangle(t, clip, balls);
    if (cover.covered) continue;
    EXPECT_LE((cover.witness - clip.center).norm(), clip.radius + 1e-9) << "seed " << seed;
  }
}

TEST(ClippedLemma, TakesDegenerateTriangles) {
  const std::vector<Triangle> flat{{Point(1, 1, 1), Point(1, 1, 1), Point(1, 1, 1)},
                                   {Point(0, 0, 0), Point(2, 2, 2), Point(1, 1, 1)},
                                   {Point(0, 0, 0), Point(2, 2, 2), Point(1, 1, 1 + 1e-14)}};
  const Sphere clip{Point(1, 1, 1.1), 0.5};
  for (const Triangle& t : flat) {
    EXPECT_TRUE(cover_of_triangle(t, clip, leaves({{clip.center, 0.51}})).covered);
    EXPECT_FALSE(cover_of_triangle(t, clip, leaves({{clip.center, 0.05}})).covered);
  }
}

// A lattice of balls whose disks just cover the plane, thousands on one triangle.
std::vector<PathBall> lattice(Index side, double factor) {
  const double spacing = 1.0 / side;
  std::vector<PathBall> balls;
  for (Index i = 0; i <= side; ++i)
    for (Index j = 0; i + j <= side + 1; ++j)
      balls.push_back({Point(i * spacing, j * spacing, 0), factor * spacing * std::sqrt(0.5), kNone, true});
  return balls;
}

TEST(ManyBalls, ThousandsOnOneTriangleCoverItUntilOneIsTakenAway) {
  const Triangle t{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
  auto balls = lattice(60, 1 + 1e-9);
  EXPECT_GT(balls.size(), 1800u);
  EXPECT_TRUE(triangle_covered(t, balls));
  EXPECT_FALSE(triangle_covered(t, lattice(60, 1 - 1e-9)));
  Random random(1, 5);
  for (int i = 0; i < 20; ++i) {
    const auto one = static_cast<std::size_t>(random.below(balls.size()));
    if ((balls[one].center.x() + balls[one].center.y()) > 0.95) continue;
    balls[one].leaf = false;
    const TriangleCover cover = cover_of_triangle(t, balls);
    EXPECT_FALSE(cover.covered);
    EXPECT_LT((cover.witness - balls[one].center).norm(), balls[one].radius);
    balls[one].leaf = true;
  }
}

// The tree of boxes must find what a look at all pairs finds: a forest beside far more balls than it needs.
TEST(ManyBalls, BallsThatDoNotMatterDoNotChangeTheAnswer) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed, 6);
    const Triangle t = random_triangle(random);
    const double size = (t[1] - t[0]).norm();
    auto balls = random_forest(random, t, random.uniform(0.4, 1) * size);
    const bool covered = triangle_covered(t, balls);
    // Small ones, each inside some leaf's path region, so that they add nothing.
    for (int added = 0; added < 100;) {
      const Point center = point_of(t, random.uniform(), random.uniform());
      const double room = -path_distance(center, balls);
      ++added;
      if (room <= 0) continue;
      balls.push_back({center, 0.9 * room, kNone, true});
    }
    EXPECT_EQ(triangle_covered(t, balls), covered) << "seed " << seed;
  }
}

}  // namespace
}  // namespace orchard
