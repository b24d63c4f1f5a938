#include "math/triangle_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice.h"

namespace orchard::runtime::detail {
namespace {

using test::Draw;
using test::Lattice;
using test::lattice_triangles_meet;
using test::LatticeTriangle;

TrianglePoints points(const LatticeTriangle& t, double unit) {
  TrianglePoints result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = unit * static_cast<double>(t[i][k]);
  }
  return result;
}

void expect_matches(const LatticeTriangle& a, const LatticeTriangle& b, double unit) {
  const bool expected = lattice_triangles_meet(a, b);
  TrianglePoints pa = points(a, unit), pb = points(b, unit);
  for (std::size_t order = 0; order < 3; ++order) {
    Vec3 witness{};
    ASSERT_EQ(triangles_intersect(pa, pb, &witness), expected);
    ASSERT_EQ(triangles_intersect(pb, pa, nullptr), expected);
    if (expected) {
      test::Triangle ta{}, tb{};
      for (std::size_t i = 0; i < 3; ++i) {
        ta[i] = {pa[i][0], pa[i][1], pa[i][2]};
        tb[i] = {pb[i][0], pb[i][1], pb[i][2]};
      }
      double size = 0;
      for (const auto& t : {pa, pb}) {
        for (const auto& p : t) size = std::max({size, std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
      }
      const std::array<long double, 3> w = {witness[0], witness[1], witness[2]};
      ASSERT_LE(test::point_distance(w, ta), 1e-7 * size);
      ASSERT_LE(test::point_distance(w, tb), 1e-7 * size);
    }
    std::rotate(pa.begin(), pa.begin() + 1, pa.end());
    std::swap(pb[0], pb[order % 2 + 1]);
  }
}

LatticeTriangle random_triangle(Draw& draw, std::uint64_t side) {
  LatticeTriangle t{};
  for (Lattice& p : t) {
    for (std::int64_t& x : p) x = static_cast<std::int64_t>(draw.bits() % side);
  }
  return t;
}

TEST(TrianglePair, DecidesNamedCases) {
  struct Case {
    const char* name;
    LatticeTriangle a, b;
    bool meet;
  };
  const LatticeTriangle base = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  const Case cases[] = {
      {"crossing", base, {{{1, 1, -1}, {1, 1, 1}, {9, 9, 1}}}, true},
      {"above", base, {{{1, 1, 1}, {2, 1, 1}, {1, 2, 2}}}, false},
      {"crosses the plane beside", base, {{{5, 5, -1}, {5, 5, 1}, {9, 9, 1}}}, false},
      {"corner on face", base, {{{1, 1, 0}, {1, 1, 5}, {2, 1, 5}}}, true},
      {"corner on edge", base, {{{2, 0, 0}, {2, -1, 5}, {3, -1, 5}}}, true},
      {"corner on corner", base, {{{4, 0, 0}, {6, 0, 1}, {6, 1, 1}}}, true},
      {"edge on edge across", base, {{{2, -1, 0}, {2, 1, 0}, {2, 0, 5}}}, true},
      {"edge crosses edge from outside", base, {{{2, -1, -1}, {2, 1, 1}, {2, -5, 0}}}, true},
      {"edge along edge", base, {{{1, 0, 0}, {3, 0, 0}, {2, -1, 3}}}, true},
      {"edge beyond edge on its line", base, {{{5, 0, 0}, {7, 0, 0}, {6, -1, 3}}}, false},
      {"equal", base, base, true},
      {"coplanar inside", base, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}, true},
      {"coplanar around", base, {{{-9, -9, 0}, {30, -9, 0}, {-9, 30, 0}}}, true},
      {"coplanar overlapping", base, {{{1, 1, 0}, {9, 1, 0}, {9, 2, 0}}}, true},
      {"coplanar apart", base, {{{5, 5, 0}, {9, 5, 0}, {5, 9, 0}}}, false},
      {"coplanar touching at a corner", base, {{{4, 0, 0}, {9, 1, 0}, {9, -1, 0}}}, true},
      {"parallel planes", base, {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}, false},
      {"segment through face", base, {{{1, 1, -1}, {1, 1, 1}, {1, 1, 1}}}, true},
      {"segment ends on face", base, {{{1, 1, 0}, {1, 1, 3}, {1, 1, 5}}}, true},
      {"segment in face", base, {{{1, 1, 0}, {1, 2, 0}, {1, 1, 0}}}, true},
      {"segment beside", base, {{{3, 3, -1}, {3, 3, 1}, {3, 3, 0}}}, false},
      {"point on face", base, {{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}, true},
      {"point off face", base, {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, false},
      {"segments crossing", {{{0, 0, 0}, {4, 4, 4}, {2, 2, 2}}}, {{{0, 4, 2}, {4, 0, 2}, {4, 0, 2}}}, true},
      {"segments skew", {{{0, 0, 0}, {4, 4, 4}, {2, 2, 2}}}, {{{0, 4, 3}, {4, 0, 3}, {4, 0, 3}}}, false},
      {"segments overlapping", {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}}, {{{1, 1, 1}, {5, 5, 5}, {3, 3, 3}}}, true},
      {"segments in line, apart", {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}}, {{{3, 3, 3}, {5, 5, 5}, {4, 4, 4}}}, false},
      {"segments parallel", {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}}, {{{0, 0, 1}, {2, 2, 3}, {1, 1, 2}}}, false},
      {"points equal", {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}, {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}, true},
      {"points different", {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}, {{{1, 2, 4}, {1, 2, 4}, {1, 2, 4}}}, false},
      {"point on segment", {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, {{{0, 0, 0}, {3, 3, 3}, {0, 0, 0}}}, true},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    ASSERT_EQ(lattice_triangles_meet(c.a, c.b), c.meet);
    for (const double unit : {1.0, 0.1, 0x1p-60, 1e15}) expect_matches(c.a, c.b, unit);
  }
}

TEST(TrianglePair, AgreesWithIntegerArithmeticOnCrowdedLattices) {
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const std::uint64_t side = 2 + draw.bits() % 4;
    const LatticeTriangle a = random_triangle(draw, side), b = random_triangle(draw, side);
    expect_matches(a, b, 1);
    if (HasFatalFailure()) return;
  }
}

// Determinants of these need up to 70 bits, and many vanish or nearly do.
TEST(TrianglePair, AgreesWithIntegerArithmeticWhereDoublesRound) {
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    LatticeTriangle a = random_triangle(draw, 4), b = random_triangle(draw, 4);
    for (LatticeTriangle* t : {&a, &b}) {
      for (Lattice& p : *t) {
        for (std::int64_t& x : p) x = x * ((1 << 21) - 1) + static_cast<std::int64_t>(draw.bits() % 8 == 0);
      }
    }
    expect_matches(a, b, 0x1p-10);
    if (HasFatalFailure()) return;
  }
}

// Doubles of very different sizes whose triples are doubles, too: points with y = 3 x are exactly in one plane, but no
// step of a plain evaluation is free of rounding.
double short_number(Draw& draw) {
  const auto digits = static_cast<double>(draw.bits() >> 14);
  return std::ldexp(draw.bits() % 2 == 0 ? digits : -digits, static_cast<int>(draw.bits() % 60) - 80);
}

TEST(ExactSign, SeesTheLastBitOfCoordinatesOfAnySize) {
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Draw draw(seed);
    const std::size_t x = draw.bits() % 3, y = (x + 1 + draw.bits() % 2) % 3, z = 3 - x - y;
    std::array<Vec3, 4> p{};
    for (Vec3& v : p) v[x] = short_number(draw), v[y] = 3 * v[x], v[z] = short_number(draw);
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), 0) << seed;
    const std::size_t moved = draw.bits() % 4;
    const double there = p[moved][y];
    p[moved][y] = 1e30;
    const int expected = orientation(p[0], p[1], p[2], p[3]);
    p[moved][y] = std::nextafter(there, std::numeric_limits<double>::infinity());
    ASSERT_NE(expected, 0) << seed;
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), expected) << seed;
    ASSERT_EQ(orientation(p[1], p[2], p[0], p[3]), expected) << seed;
    ASSERT_EQ(orientation(p[1], p[0], p[2], p[3]), -expected) << seed;
    ASSERT_EQ(orientation(p[3], p[0], p[1], p[2]), -expected) << seed;
    p[moved][y] = std::nextafter(there, -std::numeric_limits<double>::infinity());
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), -expected) << seed;
  }
}

// In a plane, next to it, and anywhere.
TEST(ExactSign, IsTheSameForManyPointsAtOnce) {
  std::size_t ties = 0, others = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Draw draw(seed);
    const std::size_t x = draw.bits() % 3, y = (x + 1 + draw.bits() % 2) % 3, z = 3 - x - y;
    std::array<Vec3, 5> p{};
    for (Vec3& v : p) v[x] = short_number(draw), v[y] = 3 * v[x], v[z] = short_number(draw);
    Vec3& moved = p[draw.bits() % 5];
    if (seed % 3 == 1) moved[y] = std::nextafter(moved[y], draw.bits() % 2 == 0 ? 1e30 : -1e30);
    if (seed % 3 == 2) moved[y] = short_number(draw);
    const std::array<Vec3, 3> points = {p[0], p[1], p[2]};
    const PlaneOrientation side(points);
    for (const std::size_t i : {3u, 4u}) {
      const int expected = orientation(p[0], p[1], p[2], p[i]);
      ASSERT_EQ(side(p[i]), expected) << seed;
      (expected == 0 ? ties : others) += 1;
    }
  }
  EXPECT_GT(ties, 10000u);
  EXPECT_GT(others, 10000u);
}

TEST(ExactSign, DecidesTurnsInEveryProjection) {
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Draw draw(seed);
    const std::size_t axis = draw.bits() % 3, x = (axis + 1) % 3, y = (axis + 2) % 3;
    std::array<Vec3, 3> p{};
    for (Vec3& v : p) v[x] = short_number(draw), v[y] = 3 * v[x], v[axis] = short_number(draw);
    ASSERT_EQ(orientation(p[0], p[1], p[2], axis), 0) << seed;
    const std::size_t moved = draw.bits() % 3;
    const Vec3 before = p[(moved + 1) % 3], after = p[(moved + 2) % 3];
    const int expected = before[x] < after[x] ? 1 : -1;  // left of the way from `before` to `after`
    const double there = p[moved][y];
    p[moved][y] = std::nextafter(there, std::numeric_limits<double>::infinity());
    ASSERT_EQ(orientation(p[0], p[1], p[2], axis), expected) << seed;
    p[moved][y] = std::nextafter(there, -std::numeric_limits<double>::infinity());
    ASSERT_EQ(orientation(p[0], p[1], p[2], axis), -expected) << seed;
  }
}

}  // namespace
}  // namespace orchard::runtime::detail
