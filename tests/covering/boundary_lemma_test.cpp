#include "orchard/covering/boundary_lemma.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "support.h"

namespace orchard {
namespace {

using namespace test;

TEST(BoundaryLemma, NeverCallsATriangleCoveredThatHasAnUncoveredPointAmongMillions) {
  std::uint64_t points = 0;
  for (std::uint64_t seed = 0; points < 2'000'000; ++seed) {
    Random random(seed, 1);
    const Triangle t = random_triangle(random);
    const double size = std::max((t[1] - t[0]).norm(), (t[2] - t[0]).norm());
    const auto balls = random_forest(random, t, size * random.uniform(0.3, 1.2));
    if (!cover_of_triangle(t, balls).covered) continue;
    for (int i = 0; i < 2000; ++i) {
      const Point p = point_of(t, random.uniform(), random.uniform());
      ASSERT_TRUE(in_some_path_region(p, balls)) << "seed " << seed;
    }
    for (const Point& corner : t) ASSERT_TRUE(in_some_path_region(corner, balls)) << "seed " << seed;
    points += 2003;
  }
}

// The least growth, to 1e-13, at which the lemma says "covered"; nothing if that is not between 0 and 8.
std::optional<double> threshold(const Triangle& t, const std::vector<PathBall>& balls) {
  double low = 0, high = 8;
  if (triangle_covered(t, grown(balls, low)) || !triangle_covered(t, grown(balls, high))) return std::nullopt;
  while (high - low > 1e-13) {
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) break;
    (triangle_covered(t, grown(balls, middle)) ? high : low) = middle;
  }
  return high;
}

TEST(BoundaryLemma, IsRarelyUncertainWhereAMarginOfOneInABillionIsLeft) {
  int regions = 0, uncertain = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 6);
    const Triangle t = random_triangle(random);
    const auto balls = random_forest(random, t, 0.5 * (t[1] - t[0]).norm());
    const auto min = threshold(t, balls);
    if (!min) continue;
    for (const double margin : {1e-9, 2e-9, 1e-8, 1e-6, 1e-3}) {
      ++regions;
      uncertain += !triangle_covered(t, grown(balls, *min + margin));
    }
  }
  RecordProperty("regions", regions);
  RecordProperty("uncertain", uncertain);
  EXPECT_GT(regions, 500);
  EXPECT_EQ(uncertain, 0);
}

TEST(BoundaryLemma, TheQuickAnswerIsTheFullOne) {
  int covered = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random random(seed, 7);
    const Triangle t = random_triangle(random);
    const auto balls = random_forest(random, t, random.uniform(0.4, 1.2) * (t[1] - t[0]).norm());
    const bool answer = triangle_covered(t, balls);
    ASSERT_EQ(answer, cover_of_triangle(t, balls).covered) << "seed " << seed;
    covered += answer;
  }
  EXPECT_GT(covered, 50);
  EXPECT_LT(covered, 950);
}

TEST(BoundaryLemma, TheCoverersAloneAreEnough) {
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    Random random(seed, 8);
    const Triangle t = random_triangle(random);
    auto balls = random_forest(random, t, (t[1] - t[0]).norm());
    const TriangleCover cover = cover_of_triangle(t, balls);
    EXPECT_EQ(cover.covered, !cover.coverers.empty());
    if (!cover.covered) continue;
    for (PathBall& ball : balls) ball.leaf = false;
    for (Index leaf : cover.coverers) balls[leaf].leaf = true;
    EXPECT_TRUE(triangle_covered(t, balls)) << "seed " << seed;
  }
}

// What the corners alone tell is no shortcut past a path: every ball from the root to the leaf must hold them.
TEST(BoundaryLemma, ATriangleInsideOnePathIsCoveredByTheFirstSuchLeafAlone) {
  const Triangle t{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
  const Point middle(0.4, 0.4, 0);
  std::vector<PathBall> balls{{middle, 0.3, kNone, false}, {middle, 5, 0, true},   {middle, 4, kNone, false},
                              {middle, 0.2, 2, true},      {middle, 1.5, 2, true}, {middle, 2, 2, true},
                              {middle, -3, kNone, false},  {middle, 3, 6, true}};
  const std::vector<Index> fifth{4};
  EXPECT_EQ(cover_of_triangle(t, balls).coverers, fifth);
  EXPECT_EQ(cover_of_triangle(t, Sphere{Point(0, 0, 0), 0.5}, balls).coverers, fifth);
  EXPECT_TRUE(triangle_covered(t, balls));
  balls[4].leaf = balls[5].leaf = false;
  EXPECT_FALSE(cover_of_triangle(t, balls).covered);
  EXPECT_FALSE(triangle_covered(t, balls));
}

// Growing every ball until the lemma just says "covered" puts three circles within 1e-12 of a common point.
TEST(BoundaryLemma, AgreesWithDenseSamplingWhereCoverageIsAboutToFail) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 2);
    const Triangle t = random_triangle(random);
    const auto balls = random_forest(random, t, 0.5 * (t[1] - t[0]).norm());
    const auto min = threshold(t, balls);
    if (!min) continue;
    const double high = *min, low = high - 1e-12;
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
    const TriangleCover failing = cover_of_triangle(t, grown(balls, low));
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
