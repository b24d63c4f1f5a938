#include "predicates/four_tetrahedra.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "support/effort.h"

namespace orchard::detail {
namespace {

bool equal_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

bool are_equal(const FourOffCenters& four, unsigned i, const OffCenter& one) {
  // A step of what has no volume is none.
  return equal_bits(four.off[i], one.off) && equal_bits(four.rest[i], one.rest) &&
         (one.off == std::numeric_limits<double>::infinity() ||
          (equal_bits(four.x[i], one.step.x()) && equal_bits(four.y[i], one.step.y()) &&
           equal_bits(four.z[i], one.step.z())));
}

// Of any size, some of them nearly or exactly flat, some with few digits, so that products are exact.
std::array<Point, 4> random_tetrahedron(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vector(unit(random), unit(random), unit(random)); };
  const double size = std::pow(10, 3 * unit(random)), off = std::pow(10, -16 * std::abs(unit(random)));
  const Point middle = vector();
  std::array<Point, 4> corners;
  for (Point& corner : corners) corner = middle + size * vector();
  switch (random() % 4) {
    case 0:
      corners[random() % 4] = corners[0] + unit(random) * (corners[1] - corners[0]) +
                              unit(random) * (corners[2] - corners[0]) + off * vector();
      break;
    case 1:
      for (Point& corner : corners) corner = (4 * corner / size).array().round();
      break;
    default:
      break;
  }
  return corners;
}

// Near the circumcentre mostly, as centres are that are looked at.
Point random_center(const std::array<Point, 4>& corners, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Vector off = std::pow(10, -18 * std::abs(unit(random))) * Vector(unit(random), unit(random), unit(random));
  Vector center;
  return sharp_circumcenter(corners[0], corners[1], corners[2], corners[3], center)
             ? Point(corners[0] + center + center.norm() * off)
             : Point(off);
}

TEST(FourTetrahedra, AreLookedAtWithTheSameBitsAsOneByOne) {
  if (!can_take_four()) GTEST_SKIP() << "this machine has no vectors of four doubles";
  std::mt19937_64 random(test::first_seed());
  int finite = 0, infinite = 0, found_at_once = 0, left = 0;
  for (std::uint64_t round = 0; round < 10'000 * test::more(); ++round) {
    std::array<std::array<Point, 4>, 4> corners;
    std::array<Point, 4> center;
    FourTetrahedra four;
    std::array<const Point*, 4> centers;
    for (unsigned i = 0; i < 4; ++i) {
      corners[i] = random_tetrahedron(random);
      center[i] = random_center(corners[i], random);
      centers[i] = &center[i];
      for (unsigned k = 0; k < 4; ++k) four[k][i] = &corners[i][k];
    }
    const FourOffCenters off = off_four_circumcenters(centers, four),
                         sharply_off = sharply_off_four_circumcenters(centers, four);
    std::array<Vector, 4> sharp;
    const unsigned found = four_sharp_circumcenters(four, sharp);
    const FourVolumes volumes = four_volumes(four);
    for (unsigned i = 0; i < 4; ++i) {
      const auto& [a, b, c, d] = corners[i];
      const Determinant one = volume(a - d, b - d, c - d);
      ASSERT_TRUE(equal_bits(volumes.value[i], one.value) && equal_bits(volumes.bound[i], one.bound));
      ASSERT_TRUE(are_equal(off, i, off_circumcenter(center[i], d, a, b, c)));
      ASSERT_TRUE(are_equal(sharply_off, i, sharply_off_circumcenter(center[i], d, a, b, c)));
      ++(off.off[i] < std::numeric_limits<double>::infinity() ? finite : infinite);
      Vector alone;
      const bool is_found = sharp_circumcenter(a, b, c, d, alone);
      if (((found >> i) & 1u) == 0) {
        ++left;
        continue;
      }
      ++found_at_once;
      ASSERT_TRUE(is_found);
      for (int axis = 0; axis < 3; ++axis) ASSERT_TRUE(equal_bits(sharp[i][axis], alone[axis]));
    }
  }
  EXPECT_GT(finite, 1000);
  EXPECT_GT(infinite, 100);
  EXPECT_GT(found_at_once, 1000);
  EXPECT_GT(left, 100);
}

TEST(FourTetrahedra, HaveTheSignsOfTheirSpheresOrNone) {
  if (!can_take_four()) GTEST_SKIP() << "this machine has no vectors of four doubles";
  std::mt19937_64 random(test::first_seed());
  std::uniform_real_distribution<double> unit(-1, 1);
  int certain = 0, uncertain = 0;
  for (std::uint64_t round = 0; round < 10'000 * test::more(); ++round) {
    std::array<std::array<Point, 4>, 4> corners;
    FourTetrahedra four;
    for (unsigned i = 0; i < 4; ++i) {
      corners[i] = random_tetrahedron(random);
      if (round % 2 == 0 && i > 0) corners[i] = corners[0];
      for (unsigned k = 0; k < 4; ++k) four[k][i] = &corners[i][k];
    }
    // On the first sphere, more or less, or one of its points.
    Point q = corners[0][0];
    Vector center;
    if (round % 8 != 0 && sharp_circumcenter(corners[0][0], corners[0][1], corners[0][2], corners[0][3], center)) {
      const Vector away = Vector(unit(random), unit(random), unit(random)).normalized();
      q += center + center.norm() * (1 + std::pow(10, -20 * std::abs(unit(random)))) * away;
    }
    const std::array<Sign, 4> signs = four_inside_spheres(q, four);
    for (unsigned i = 0; i < 4; ++i) {
      const auto& [a, b, c, d] = corners[i];
      ++(signs[i] == Sign::uncertain ? uncertain : certain);
      if (signs[i] == Sign::uncertain) continue;
      ASSERT_EQ(signs[i], inside_sphere(q, a, b, c, d));
    }
  }
  EXPECT_GT(certain, 10'000);
  EXPECT_GT(uncertain, 1000);
}

}  // namespace
}  // namespace orchard::detail
