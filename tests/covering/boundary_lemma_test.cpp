#include "orchard/covering/boundary_lemma.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "orchard/geometry/random.h"

namespace orchard {
namespace {

using Triangle = std::array<Point, 3>;

Vector random_vector(Random& random, double size = 1) {
  return size * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

Triangle random_triangle(Random& random) {
  return {random_vector(random), random_vector(random), random_vector(random)};
}

// Closed sets, no tolerance: what the certificate promises.
bool in_some_path_region(const Point& point, std::span<const PathBall> balls) {
  std::vector<char> inside(balls.size(), 0);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    inside[i] =
        (balls[i].parent == kNone || inside[balls[i].parent]) && (point - balls[i].center).norm() <= balls[i].radius;
    if (inside[i] && balls[i].leaf) return true;
  }
  return false;
}

Point point_of(const Triangle& t, double u, double v) {
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

std::vector<PathBall> leaves(std::initializer_list<Sphere> spheres) {
  std::vector<PathBall> balls;
  for (const Sphere& s : spheres) balls.push_back({s.center, s.radius, kNone, true});
  return balls;
}

// Balls of random sizes around points near the triangle, as a forest of random depth.
std::vector<PathBall> random_forest(Random& random, const Triangle& t, double scale) {
  const auto count = static_cast<Index>(4 + random.below(40));
  std::vector<PathBall> balls;
  std::vector<char> has_child(count, 0);
  for (Index i = 0; i < count; ++i) {
    PathBall ball{point_of(t, random.uniform(), random.uniform()) + random_vector(random, 0.2 * scale),
                  scale * random.uniform(0.2, 0.9), kNone, true};
    if (i > 0 && random.below(3) > 0) {
      ball.parent = static_cast<Index>(random.below(i));
      has_child[ball.parent] = 1;
    }
    balls.push_back(ball);
  }
  for (Index i = 0; i < count; ++i) balls[i].leaf = !has_child[i];
  return balls;
}

TEST(BoundaryLemma, NeverCallsATriangleCoveredThatHasAnUncoveredPoint) {
  int covered = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    Random random(seed, 1);
    const Triangle t = random_triangle(random);
    const double size = std::max((t[1] - t[0]).norm(), (t[2] - t[0]).norm());
    const auto balls = random_forest(random, t, size * random.uniform(0.3, 1.2));
    if (!cover_of_triangle(t, balls).covered) continue;
    ++covered;
    for (int i = 0; i < 500; ++i) {
      const Point p = point_of(t, random.uniform(), random.uniform());
      ASSERT_TRUE(in_some_path_region(p, balls)) << "seed " << seed;
    }
    for (const Point& corner : t) ASSERT_TRUE(in_some_path_region(corner, balls)) << "seed " << seed;
  }
  EXPECT_GT(covered, 400);
}

// Growing every ball until the lemma just says "covered" puts three circles within 1e-12 of a common point.
TEST(BoundaryLemma, AgreesWithDenseSamplingWhereCoverageIsAboutToFail) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 2);
    const Triangle t = random_triangle(random);
    auto balls = random_forest(random, t, 0.5 * (t[1] - t[0]).norm());
    const auto grown = [&](double by) {
      auto copy = balls;
      for (PathBall& ball : copy) ball.radius += by;
      return copy;
    };
    double low = 0, high = 8;
    if (cover_of_triangle(t, grown(low)).covered || !cover_of_triangle(t, grown(high)).covered) continue;
    while (high - low > 1e-13) {
      const double middle = (low + high) / 2;
      if (middle <= low || middle >= high) break;
      (cover_of_triangle(t, grown(middle)).covered ? high : low) = middle;
    }
    // Sound just above the threshold, and complete just below it.
    double worst = -1;  // growth that the least covered sample needs
    const auto need = [&](const Point& p) {
      std::vector<double> path(balls.size());
      double best = 1e300;
      for (std::size_t i = 0; i < balls.size(); ++i) {
        path[i] = (p - balls[i].center).norm() - balls[i].radius;
        if (balls[i].parent != kNone) path[i] = std::max(path[i], path[balls[i].parent]);
        if (balls[i].leaf) best = std::min(best, path[i]);
      }
      worst = std::max(worst, best);
    };
    const int n = 60;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) need(point_of(t, static_cast<double>(i) / n, static_cast<double>(j) / n));
    // Where the lemma, just below the threshold, says that something is uncovered, it must be right.
    const TriangleCover failing = cover_of_triangle(t, grown(low));
    need(failing.witness);
    for (const UncoveredArc& arc : failing.arcs) need(arc.middle);
    ASSERT_LE(worst, high + 1e-12) << "seed " << seed;
    ASSERT_GE(worst, high - 1e-9) << "declared uncovered with room to spare, seed " << seed;
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST(BoundaryLemma, SeesAHoleOfAMillionthMillionthBetweenThreeBalls) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed, 3);
    // Three balls around a random point of a random plane, which meet in that point alone.
    const Point hole = random_vector(random);
    const Vector x = random_vector(random).normalized();
    const Vector y = random_vector(random).cross(x).normalized();
    const Vector normal = x.cross(y);
    const auto around = [&](double angle, double distance) {
      return Point(hole + distance * (std::cos(angle) * x + std::sin(angle) * y));
    };
    const double turn = random.uniform(0, 6.28);
    const Triangle t{around(turn, 0.2), around(turn + 2.2, 0.2), around(turn + 4.1, 0.2)};
    const double tilt = random.uniform(-0.5, 0.5);
    for (const double gap : {1e-12, 1e-9, 1e-6, -1e-12, -1e-9}) {
      std::vector<PathBall> balls;
      for (int i = 0; i < 3; ++i) {
        const Point center = around(turn + i * 2.0943951023931953, 1) + tilt * normal;
        balls.push_back({center, (center - hole).norm() - gap, kNone, true});
      }
      EXPECT_EQ(cover_of_triangle(t, balls).covered, gap < 0) << "seed " << seed << ", gap " << gap;
    }
  }
}

TEST(BoundaryLemma, EqualBallsDoNotVouchForEachOther) {
  const Triangle t{Point(0, 0, 0), Point(4, 0, 0), Point(0, 4, 0)};
  const Sphere half{Point(0, 0, 0), 2};
  EXPECT_FALSE(cover_of_triangle(t, leaves({half, half})).covered);
  EXPECT_FALSE(cover_of_triangle(t, leaves({half, {half.center, half.radius + 1e-15}})).covered);
}

TEST(BoundaryLemma, AParentInsideBothItsChildrenStillNeedsItsOwnBoundaryCovered) {
  const Triangle t{Point(0, 0, 0), Point(4, 0, 0), Point(0, 4, 0)};
  const std::vector<PathBall> balls{{Point(0, 0, 0), 10, kNone, false},
                                    {Point(1, 1, 0), 1, 0, false},
                                    {Point(1, 1, 0), 3, 1, true},
                                    {Point(1, 1, 0), 2, 1, true}};
  const TriangleCover cover = cover_of_triangle(t, balls);
  EXPECT_FALSE(cover.covered);
  ASSERT_FALSE(cover.arcs.empty());
  EXPECT_EQ(cover.arcs.front().ball, 1u);
}

TEST(BoundaryLemma, AcceptsADiskInsideTheTriangleOnlyWithSomethingAroundIt) {
  const Triangle t{Point(0, 0, 0), Point(4, 0, 0), Point(0, 4, 0)};
  const Sphere inside{Point(1, 1, 0), 0.3}, around{Point(1.5, 1.5, 0), 4};
  EXPECT_FALSE(cover_of_triangle(t, leaves({inside})).covered);
  EXPECT_TRUE(cover_of_triangle(t, leaves({inside, around})).covered);
  EXPECT_TRUE(cover_of_triangle(t, leaves({around})).covered);
}

TEST(BoundaryLemma, FindsNothingCoveredWhereNoBallTouches) {
  const Triangle t{Point(0, 0, 0), Point(4, 0, 0), Point(0, 4, 0)};
  const TriangleCover cover = cover_of_triangle(t, leaves({{Point(0, 0, 9), 1}, {Point(20, 0, 0), 3}}));
  EXPECT_FALSE(cover.covered);
  EXPECT_TRUE(cover.arcs.empty());
  EXPECT_FALSE(cover_of_triangle(t, {}).covered);
}

TEST(BoundaryLemma, IgnoresLeavesWhosePathLeavesTheTriangleUncovered) {
  const Triangle t{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
  // The child would do, but its parent holds only a part.
  const std::vector<PathBall> balls{{Point(0, 0, 0), 0.5, kNone, false}, {Point(0, 0, 0), 5, 0, true}};
  EXPECT_FALSE(cover_of_triangle(t, balls).covered);
}

struct Named {
  const char* name;
  Triangle triangle;
};

TEST(BoundaryLemma, HandlesDegenerateTriangles) {
  const std::vector<Named> cases{
      {"point", {Point(1, 1, 1), Point(1, 1, 1), Point(1, 1, 1)}},
      {"segment", {Point(0, 0, 0), Point(1, 0, 0), Point(0.25, 0, 0)}},
      {"slanted segment", {Point(0, 0, 0), Point(0.1, 0.2, 0.3), Point(0.3, 0.6, 0.9)}},
      {"repeated corner", {Point(0, 0, 0), Point(1, 0.5, 0), Point(1, 0.5, 0)}},
      {"needle", {Point(0, 0, 0), Point(1, 0, 0), Point(0.5, 1e-13, 0)}},
      {"flat needle", {Point(0, 0, 0), Point(1, 1, 1), Point(0.4, 0.4, 0.4 + 1e-15)}},
  };
  for (const Named& c : cases) {
    const Point middle = (c.triangle[0] + c.triangle[1] + c.triangle[2]) / 3;
    EXPECT_TRUE(cover_of_triangle(c.triangle, leaves({{middle, 2}})).covered) << c.name;
    EXPECT_FALSE(cover_of_triangle(c.triangle, leaves({{middle + Vector(9, 0, 0), 2}})).covered) << c.name;
    double length = 0;
    for (const Point& corner : c.triangle) length = std::max(length, (corner - middle).norm());
    if (length == 0) continue;
    EXPECT_FALSE(cover_of_triangle(c.triangle, leaves({{middle, 0.5 * length}})).covered) << c.name;
    // Two balls that overlap in the middle and together hold the whole.
    const Point a = c.triangle[0],
                far_end = (c.triangle[1] - a).norm() > (c.triangle[2] - a).norm() ? c.triangle[1] : c.triangle[2];
    const Point b = (far_end - a).norm() > 0 ? far_end : c.triangle[1];
    const double half = 0.5 * (b - a).norm();
    EXPECT_TRUE(cover_of_triangle(c.triangle, leaves({{a, half * 1.01}, {b, half * 1.01}})).covered) << c.name;
    EXPECT_FALSE(cover_of_triangle(c.triangle, leaves({{a, half * 0.99}, {b, half * 0.99}})).covered) << c.name;
  }
}

TEST(BoundaryLemma, GivesTheSameAnswerAtAnyScaleAndAMillionTimesItsSizeAway) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed, 4);
    const Triangle t = random_triangle(random);
    const auto balls = random_forest(random, t, 0.6 * (t[1] - t[0]).norm());
    const bool covered = cover_of_triangle(t, balls).covered;
    const auto moved = [&](double scale, const Vector& offset) {
      Triangle triangle = t;
      for (Point& p : triangle) p = scale * p + offset;
      auto copy = balls;
      for (PathBall& ball : copy) ball.center = scale * ball.center + offset, ball.radius *= scale;
      return cover_of_triangle(triangle, copy).covered;
    };
    EXPECT_EQ(covered, moved(0x1p-20, Vector::Zero())) << "seed " << seed;
    EXPECT_EQ(covered, moved(0x1p+20, Vector::Zero())) << "seed " << seed;
    EXPECT_EQ(covered, moved(1, Vector(1e6, -1e6, 1e6))) << "seed " << seed;
  }
}

TEST(BoundaryLemma, ReportsArcsThatLieOnTheNamedBall) {
  int arcs = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 5);
    const Triangle t = random_triangle(random);
    const auto balls = random_forest(random, t, 0.4 * (t[1] - t[0]).norm());
    const TriangleCover cover = cover_of_triangle(t, balls);
    for (const UncoveredArc& arc : cover.arcs) {
      ++arcs;
      for (const Point& p : {arc.begin, arc.middle, arc.end})
        EXPECT_NEAR((p - balls[arc.ball].center).norm(), balls[arc.ball].radius, 1e-10) << "seed " << seed;
    }
  }
  EXPECT_GT(arcs, 100);
}

}  // namespace
}  // namespace orchard
