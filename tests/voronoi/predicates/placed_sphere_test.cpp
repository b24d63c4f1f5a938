#include "predicates/placed_sphere.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "support/effort.h"

namespace orchard::detail {
namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
bool same_or_no_number(double a, double b) { return same_bits(a, b) || (std::isnan(a) && std::isnan(b)); }

// Three vectors of any lengths: some of them nearly in a plane or on a line with the new point, some none at all.
std::array<LengthedVector, 3> random_triangle(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vector(unit(random), unit(random), unit(random)); };
  const double size = std::pow(10, 3 * unit(random)), off = std::pow(10, -8 * std::abs(unit(random)));
  const Vector a = size * vector(), b = size * vector();
  Vector c = size * vector();
  switch (random() % 4) {
    case 0:
      c = unit(random) * a + unit(random) * b + off * c;
      break;
    case 1:
      c = a + off * c;
      break;
    case 2:
      if (random() % 8 == 0) c = Vector::Zero();
      break;
    default:
      break;
  }
  return {LengthedVector(a), LengthedVector(b), LengthedVector(c)};
}

TEST(PlacedSpheres, AreTheSameFourAtATimeBitForBitAndGoodOnlyWithinTheLimits) {
  if (!can_place_four()) GTEST_SKIP() << "this machine has no vectors of four doubles";
  const PlacingLimits limits{
      .noise = 0x1p-50, .max_shake = 1e-3, .max_condition = 1e6, .max_poverty = 1e-4, .min_bound = 0x1p-60};
  std::mt19937_64 random(test::first_seed());
  std::uniform_real_distribution<double> unit(-1, 1);
  int good = 0, not_good = 0;
  for (std::uint64_t round = 0; round < 20'000 * test::more(); ++round) {
    const Point q(unit(random), unit(random), unit(random));
    std::vector<std::array<LengthedVector, 3>> triangles;
    FourTriangles four;
    for (std::size_t i = 0; i < 4; ++i) triangles.push_back(random_triangle(random));
    for (std::size_t i = 0; i < 4; ++i)
      four.a[i] = &triangles[i][0], four.b[i] = &triangles[i][1], four.c[i] = &triangles[i][2];
    std::array<VoronoiVertex, 4> vertices;
    FourQualities qualities;
    place_four(q, limits, four, vertices.data(), qualities);
    for (unsigned i = 0; i < 4; ++i) {
      const auto& [a, b, c] = triangles[i];
      const PlacedSphere one = placed_sphere(q, limits.noise, a, b, c);
      for (int axis = 0; axis < 3; ++axis) ASSERT_TRUE(same_or_no_number(vertices[i].center[axis], one.center[axis]));
      ASSERT_TRUE(same_or_no_number(vertices[i].radius, one.squared_radius));
      if (qualities.good != 0xf) {
        const PlacedQuality found = qualities[i];
        ASSERT_TRUE(same_or_no_number(found.volume6, one.quality.volume6));
        ASSERT_TRUE(same_or_no_number(found.condition, one.quality.condition));
        ASSERT_TRUE(same_or_no_number(found.shake, one.quality.shake));
        ASSERT_TRUE(same_or_no_number(found.error, one.quality.error));
      }
      const bool is_good = ((qualities.good >> i) & 1u) != 0;
      ++(is_good ? good : not_good);
      if (!is_good) continue;
      ASSERT_TRUE(one.quality.reliable());
      ASSERT_GT(one.quality.volume6, 0);
      ASSERT_LT(one.quality.shake, limits.max_shake);
      ASSERT_LT(one.quality.condition, limits.max_condition);
      const double bound = std::ldexp(limits.min_bound, 2 * static_cast<int>(qualities.error_class[i]));
      ASSERT_LE(one.quality.error, bound);
      ASSERT_LT(bound, limits.max_poverty * one.squared_radius);
      // The smallest such power.
      if (qualities.error_class[i] > 0) {
        ASSERT_GT(one.quality.error, bound / 4);
      }
    }
  }
  EXPECT_GT(good, 1000);
  EXPECT_GT(not_good, 1000);
}

}  // namespace
}  // namespace orchard::detail
