#include "predicates/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "orchard/geometry/random.h"
#include "support/effort.h"
#include "voronoi/point_sets.h"

namespace orchard::detail {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 cgal(const Point& p) { return {p.x(), p.y(), p.z()}; }

// Sets of which many fives are cospherical, fours coplanar and threes collinear: exactly, or but for rounding.
std::vector<test::Points> awkward_sets() {
  return {test::grid_points(4),
          test::turned(test::grid_points(4), 1),
          test::sphere_points(60, 1),
          test::cone_ring_points(10, 8),
          test::turned(test::cone_ring_points(10, 8), 2),
          test::moved(test::turned(test::grid_points(4), 3), 1e-9, Vector(1, 2, 3)),
          test::moved(test::cone_ring_points(10, 8), 0x1p100, Vector::Zero()),
          test::moved(test::sphere_points(60, 2), 0x1p-140, Vector::Zero()),
          test::uniform_points(60, 3)};
}

TEST(Predicates, HaveTheSignsOfExactArithmetic) {
  int zero = 0;
  for (const test::Points& points : awkward_sets())
    for (std::uint64_t trial = 0; trial < 4000; ++trial) {
      Random random(1, 12, trial);
      std::array<Point, 5> p;
      for (Point& q : p) q = points[random.below(points.size())];
      const auto volume = CGAL::orientation(cgal(p[0]), cgal(p[1]), cgal(p[2]), cgal(p[3]));
      ASSERT_EQ(static_cast<int>(volume_sign(p[0], p[1], p[2], p[3])), static_cast<int>(volume));
      if (volume == CGAL::ZERO) continue;
      if (volume == CGAL::NEGATIVE) std::swap(p[0], p[1]);
      const auto inside = CGAL::side_of_oriented_sphere(cgal(p[0]), cgal(p[1]), cgal(p[2]), cgal(p[3]), cgal(p[4]));
      ASSERT_EQ(static_cast<int>(inside_sphere(p[4], p[0], p[1], p[2], p[3])), static_cast<int>(inside));
      zero += inside == CGAL::ON_ORIENTED_BOUNDARY;
    }
  EXPECT_GT(zero, 1000) << "the sets are not awkward enough";
}

// As far from the origin as points of a frame, apart by as many units as doubles can multiply without rounding, by a
// few more and by a few less; and one coordinate that is half a unit off.
TEST(Predicates, HaveTheSignsOfExactArithmeticWhereDoublesAreJustExact) {
  int zero = 0;
  for (int bits = 2; bits <= 20; ++bits)
    for (const double offset : {0.0, -3.0, 3.0})
      for (std::uint64_t trial = 0; trial < 1000; ++trial) {
        Random random(1, static_cast<std::uint64_t>(bits), trial);
        const double unit = 0x1p-44;
        // Few values of each coordinate, the extreme ones among them, so that many points are on one plane or sphere.
        const auto coordinate = [&] {
          const std::uint64_t most = (std::uint64_t{1} << bits) - 1;
          return offset + unit * static_cast<double>(std::array{std::uint64_t{0}, most, most / 2}[random.below(3)]);
        };
        std::array<Point, 5> p;
        for (Point& q : p) q = Point(coordinate(), coordinate(), coordinate());
        if (trial % 2 == 1) p[random.below(5)].z() += unit / 2;
        const auto volume = CGAL::orientation(cgal(p[0]), cgal(p[1]), cgal(p[2]), cgal(p[3]));
        ASSERT_EQ(static_cast<int>(volume_sign(p[0], p[1], p[2], p[3])), static_cast<int>(volume)) << bits;
        if (volume == CGAL::ZERO) continue;
        if (volume == CGAL::NEGATIVE) std::swap(p[0], p[1]);
        const auto inside = CGAL::side_of_oriented_sphere(cgal(p[0]), cgal(p[1]), cgal(p[2]), cgal(p[3]), cgal(p[4]));
        ASSERT_EQ(static_cast<int>(inside_sphere(p[4], p[0], p[1], p[2], p[3])), static_cast<int>(inside)) << bits;
        zero += inside == CGAL::ON_ORIENTED_BOUNDARY;
      }
  EXPECT_GT(zero, 1000) << "the points are not awkward enough";
}

// Coordinates of many digits, of which few are different, so that most fours have some in common; and one that is off
// by the last digit.
TEST(VolumeSign, IsThatOfExactArithmeticForPointsThatShareCoordinates) {
  int zero = 0, shaken = 0;
  for (std::uint64_t trial = 0; trial < 20000; ++trial) {
    Random random(1, 14, trial);
    std::array<Point, 3> values;
    for (Point& value : values) value = {random.uniform(), random.uniform(), random.uniform()};
    std::array<Point, 4> p;
    for (Point& q : p)
      for (unsigned axis = 0; axis < 3; ++axis) q[axis] = values[random.below(2 + trial % 2)][axis];
    if (trial % 3 == 0) p[trial % 4][trial / 3 % 3] *= 1 + std::numeric_limits<double>::epsilon();
    const auto volume = CGAL::orientation(cgal(p[0]), cgal(p[1]), cgal(p[2]), cgal(p[3]));
    ASSERT_EQ(static_cast<int>(volume_sign(p[0], p[1], p[2], p[3])), static_cast<int>(volume));
    zero += volume == CGAL::ZERO;
    shaken += volume != CGAL::ZERO && trial % 3 == 0;
  }
  EXPECT_GT(zero, 5000);
  EXPECT_GT(shaken, 1000);
}

TEST(VolumeSign, IsUncertainWhereTheVolumeIsNotFartherFromZeroThanAsked) {
  // Four points of a line but for 2^-36: the volume, -2^-72, is far below the rounding of the products.
  const Point p(0, 0, 0), a(1, 1, 1), b(2, 2, 2 + 0x1p-36), c(3, 3 + 0x1p-36, 3);
  for (const double indifferent : {0.0, 0x1p-74, 0x1.ffffp-73})
    EXPECT_EQ(volume_sign(p, a, b, c, indifferent), Sign::negative) << indifferent;
  for (const double indifferent : {0x1p-72, 0x1p-70, 1.0})
    EXPECT_EQ(volume_sign(p, a, b, c, indifferent), Sign::uncertain) << indifferent;
  EXPECT_EQ(volume_sign(p, b, a, c, 0x1p-73), Sign::positive);
}

TEST(SharpNormal, IsRightForThreePointsThatAreStraightButForTheLastRounding) {
  // Their cross product is below what doubles of twice the precision resolve.
  const Point a(-0.10000000000000001, 1.2246467991473533e-17, 0.80000000000000004);
  const Point b(-0.20999999999999999, 2.5717582782094416e-17, 0.58000000000000007);
  const Point c(-0.22, 2.6942229581241769e-17, 0.56000000000000005);
  Vector normal;
  ASSERT_TRUE(sharp_normal(a, b, c, normal));
  EXPECT_NEAR(normal.norm(), 1, 1e-15);
  EXPECT_LT(std::abs(normal.dot((b - a).normalized())), 1e-15);
  EXPECT_FALSE(sharp_normal(Point(0, 0, 0), Point(1, 2, 3), Point(3, 6, 9), normal));
}

TEST(SharpCircumcenter, IsEquallyFarFromItsPoints) {
  for (const double height : {1.0, 1e-6, 1e-12, 0x1p-52}) {
    const Point a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(0.3, 0.4, height);
    Vector center;
    ASSERT_TRUE(sharp_circumcenter(a, b, c, d, center));
    EXPECT_EQ(center.x(), 0.5);
    EXPECT_EQ(center.y(), 0.5);
    // |d|^2 = 2 center . d
    EXPECT_NEAR(center.z() * height, (0.25 + height * height - 0.7) / 2, 1e-15);
  }
  Vector center;
  EXPECT_FALSE(sharp_circumcenter(Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(1, 1, 0), center));
}

// The distance from a circumcentre, rounded once at the end.
double exact_distance(const Point& center, const std::array<Point, 4>& p) {
  using Rational = CGAL::Simple_cartesian<CGAL::Exact_rational>;
  const auto exact = [](const Point& q) { return Rational::Point_3(q.x(), q.y(), q.z()); };
  const auto own = CGAL::circumcenter(exact(p[0]), exact(p[1]), exact(p[2]), exact(p[3]));
  return std::sqrt(CGAL::to_double(CGAL::squared_distance(own, exact(center))));
}

// Between two short edges of the curve (t, t^2, t^3), off the origin, as thin as a millionth or less.
std::array<Point, 4> needle(Random& random) {
  const double s = random.uniform(), t = random.uniform(), step = std::pow(10, -6 * random.uniform());
  const auto on_curve = [](double at) { return Point(0.25 + at, at * at, at * at * at - 0.5); };
  return {on_curve(s), on_curve(s + step), on_curve(t), on_curve(t + step)};
}

// With centres that are off by a few roundings or by much more.
TEST(OffCircumcenter, BoundsTheDistanceByAFewRoundingsOfShortEdges) {
  int trusted = 0;
  const int trials = 2000 * static_cast<int>(test::more());
  for (int trial = 0; trial < trials; ++trial) {
    Random random(1, 13, test::first_seed() + static_cast<std::uint64_t>(trial));
    std::array<Point, 4> p = needle(random);
    const RelativeCenter relative =
        circumcenter(LengthedVector(p[1] - p[0]), LengthedVector(p[2] - p[0]), LengthedVector(p[3] - p[0]));
    if (!relative.reliable()) continue;
    Point center = p[0] + relative.center;
    if (trial % 4 == 0) center.y() += std::pow(10, -12 * random.uniform());
    const double distance = exact_distance(center, p), slack = 1 + 0x1p-48;
    const double edges = (p[1] - p[0]).norm() * (p[2] - p[0]).norm() * (p[3] - p[2]).norm();
    const double rounding = 256 * kRounding * edges * relative.center.norm() / std::abs(relative.volume6);
    for (const auto& [first, second] :
         {std::array{1u, 2u}, std::array{2u, 1u}, std::array{2u, 3u}, std::array{3u, 1u}}) {
      const double off = off_circumcenter(center, p[0], p[first], p[second], p[6 - first - second]).off;
      ASSERT_GE(off * slack, distance) << trial;
      if (!(rounding < 0x1p-20)) continue;
      ASSERT_LE(off, 2 * distance + rounding) << trial;
      ++trusted;
    }
  }
  EXPECT_GT(trusted, 2 * trials);
}

// The same needles: what is left after the step is bounded too, and with more digits that is next to nothing.
TEST(OffCircumcenter, TellsAStepToTheCircumcenter) {
  int near = 0;
  const int trials = 2000 * static_cast<int>(test::more());
  for (int trial = 0; trial < trials; ++trial) {
    Random random(2, 13, test::first_seed() + static_cast<std::uint64_t>(trial));
    const std::array<Point, 4> p = needle(random);
    const RelativeCenter relative =
        circumcenter(LengthedVector(p[1] - p[0]), LengthedVector(p[2] - p[0]), LengthedVector(p[3] - p[0]));
    if (!relative.reliable()) continue;
    const double radius = relative.center.norm();
    Point center = p[0] + relative.center;
    if (trial % 2 == 0) center.y() += radius * std::pow(10, -4 - 12 * random.uniform());
    const double distance = exact_distance(center, p), slack = 1 + 0x1p-48;
    const auto left = [&](const OffCenter& seen) {
      const Point moved = center - seen.step;
      return std::pair(exact_distance(moved, p), seen.rest + 2 * kRounding * moved.lpNorm<1>());
    };
    const OffCenter seen = off_circumcenter(center, p[0], p[1], p[2], p[3]),
                    sharp = sharply_off_circumcenter(center, p[0], p[1], p[2], p[3]);
    ASSERT_GE(sharp.off * slack, distance) << trial;
    for (const OffCenter& each : {seen, sharp}) {
      if (each.off == std::numeric_limits<double>::infinity()) continue;
      const auto [apart, bound] = left(each);
      ASSERT_LE(apart, bound * slack) << trial;
    }
    near += sharp.rest <= 0x1p-20 * sharp.off + 0x1p-46 * radius;
  }
  EXPECT_GT(near, trials / 2);
}

TEST(OffCircumcenter, IsInfiniteWhereTheVolumeIsInDoubt) {
  const Point q(0, 0, 0), a(1, 0, 0), b(0, 1, 0), c(1, 1, 0);
  for (const OffCenter& seen :
       {off_circumcenter(Point(0.5, 0.5, 0), q, a, b, c), sharply_off_circumcenter(Point(0.5, 0.5, 0), q, a, b, c)}) {
    EXPECT_EQ(seen.off, std::numeric_limits<double>::infinity());
    EXPECT_EQ(seen.rest, std::numeric_limits<double>::infinity());
  }
}

}  // namespace
}  // namespace orchard::detail
