#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using Corners = std::array<Point, 3>;

// ---- An oracle for small integer coordinates. Convex sets meet iff their Minkowski difference holds the origin; by
// Caratheodory, iff the hull of some one to four of the nine corner differences does. All signs are exact in integers.

using Whole = std::array<std::int64_t, 3>;

std::int64_t dot(const Whole& a, const Whole& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Whole minus(const Whole& a, const Whole& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Whole cross(const Whole& a, const Whole& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::int64_t det(const Whole& a, const Whole& b, const Whole& c) { return dot(a, cross(b, c)); }

bool segment_holds_origin(const Whole& p, const Whole& q) {
  const Whole c = cross(p, q);
  return dot(c, c) == 0 && dot(p, q) <= 0;
}

bool triangle_holds_origin(const Whole& p, const Whole& q, const Whole& r) {
  const Whole normal = cross(minus(q, p), minus(r, p));
  return dot(normal, normal) > 0 && dot(normal, p) == 0 && dot(cross(q, r), normal) >= 0 &&
         dot(cross(r, p), normal) >= 0 && dot(cross(p, q), normal) >= 0;
}

bool tetrahedron_holds_origin(const Whole& p, const Whole& q, const Whole& r, const Whole& s) {
  const std::int64_t whole = det(minus(q, p), minus(r, p), minus(s, p));
  if (whole == 0) return false;
  const std::int64_t sign = whole > 0 ? 1 : -1;
  return sign * det(q, r, s) >= 0 && sign * -det(p, r, s) >= 0 && sign * det(p, q, s) >= 0 && sign * -det(p, q, r) >= 0;
}

bool oracle(const Corners& a, const Corners& b) {
  std::vector<Whole> d;
  for (const Point& p : a)
    for (const Point& q : b) {
      const Point r = p - q;
      d.push_back({std::llround(r.x()), std::llround(r.y()), std::llround(r.z())});
    }
  for (std::size_t i = 0; i < d.size(); ++i)
    for (std::size_t j = i; j < d.size(); ++j) {
      if (segment_holds_origin(d[i], d[j])) return true;
      for (std::size_t k = j + 1; k < d.size(); ++k) {
        if (triangle_holds_origin(d[i], d[j], d[k])) return true;
        for (std::size_t l = k + 1; l < d.size(); ++l)
          if (tetrahedron_holds_origin(d[i], d[j], d[k], d[l])) return true;
      }
    }
  return false;
}

Corners random_grid_triangle(Random& random, std::size_t size) {
  Corners result;
  const auto coordinate = [&] { return static_cast<double>(random.below(size)); };
  for (Point& p : result) p = {coordinate(), coordinate(), coordinate()};
  return result;
}

Corners moved(Corners triangle, double scale, double offset) {
  for (Point& p : triangle) p = scale * p + Vector::Constant(offset);
  return triangle;
}

TEST(TrianglesMeet, AgreesWithAnExactOracleOnAGridFullOfTouchingAndDegenerateTriangles) {
  std::size_t meeting = 0, degenerate = 0;
  const std::size_t rounds = 20000;
  for (std::size_t i = 0; i < rounds; ++i) {
    Random random(11, i);
    const std::size_t size = 2 + i % 5;  // the smaller the grid, the more degenerate
    const Corners a = random_grid_triangle(random, size), b = random_grid_triangle(random, size);
    const bool expected = oracle(a, b);
    ASSERT_EQ(triangles_meet(a, b), expected) << i;
    ASSERT_EQ(triangles_meet(b, a), expected) << i;
    ASSERT_EQ(triangles_meet({a[2], a[0], a[1]}, {b[1], b[0], b[2]}), expected) << i;
    // Powers of two and whole offsets keep the coordinates exact.
    ASSERT_EQ(triangles_meet(moved(a, 0x1p-20, 0), moved(b, 0x1p-20, 0)), expected) << i;
    ASSERT_EQ(triangles_meet(moved(a, 0x1p20, 1e6), moved(b, 0x1p20, 1e6)), expected) << i;
    meeting += expected;
    degenerate += (a[1] - a[0]).cross(a[2] - a[0]).norm() == 0;
  }
  EXPECT_GT(meeting, rounds / 10);
  EXPECT_LT(meeting, rounds - rounds / 10);
  EXPECT_GT(degenerate, rounds / 100);
}

TEST(TrianglesMeet, TellsATouchFromTheNextDoubleAway) {
  const Corners flat{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
  for (int i = 0; i < 1000; ++i) {
    Random random(3, static_cast<std::uint64_t>(i));
    const Point tip(0.25 * random.uniform(), 0.25 * random.uniform(), 0);
    Corners above{tip, tip + Vector(1, 2, 3), tip + Vector(-2, 1, 5)};
    EXPECT_TRUE(triangles_meet(flat, above));
    above[0].z() = 0x1p-1000;
    EXPECT_FALSE(triangles_meet(flat, above));
    above[0].z() = -0x1p-1000;
    EXPECT_TRUE(triangles_meet(flat, above));
  }
}

// ---- The query on a whole surface

TriangleMesh random_soup(std::uint64_t seed, bool on_a_grid) {
  Random random(seed, 1);
  TriangleMesh mesh;
  for (Index t = 0; t < 150; ++t) {
    Corners corners = random_grid_triangle(random, 6);
    if (!on_a_grid) {
      const Point corner(6 * random.uniform(), 6 * random.uniform(), 6 * random.uniform());
      for (Point& p : corners) p = corner + 0.2 * p;
    }
    mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

void expect_what_a_loop_finds(const TriangleMesh& mesh, std::uint64_t seed) {
  const Surface surface(mesh);
  const Box& box = surface.bounding_box();
  std::vector<Index> found;
  std::size_t total = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    Random random(seed, i);
    const auto somewhere = [&](double size) {
      const Vector d(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
      return Point(box.center() + size * d.cwiseProduct(box.sizes()));
    };
    Corners query{somewhere(1), somewhere(1), somewhere(1)};
    const Corners own = surface.corners(static_cast<Index>(random.below(mesh.triangles.size())));
    if (i % 5 == 1) query = own;
    if (i % 5 == 2) query = {own[0], own[1], somewhere(1)};
    if (i % 5 == 3) query = {own[0], somewhere(1e3), somewhere(1e7)};
    if (i % 5 == 4) query = {somewhere(1), somewhere(1), query[0]};
    std::vector<Index> expected;
    for (Index t = 0; t < mesh.triangles.size(); ++t)
      if (triangles_meet(query, surface.corners(t))) expected.push_back(t);
    surface.triangles_overlapping(query, found);
    ASSERT_EQ(found, expected) << i;
    total += found.size();
  }
  EXPECT_GT(total, 200u);
}

TEST(Surface, FindsExactlyTheTrianglesThatMeetATriangle) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    expect_what_a_loop_finds(random_soup(seed, false), seed);
    expect_what_a_loop_finds(random_soup(seed, true), seed);
  }
  for (const TriangleMesh& mesh : {test::icosphere(3), test::torus(24, 12), test::u_shape(0.1), test::open_box()}) {
    expect_what_a_loop_finds(mesh, 21);
    expect_what_a_loop_finds(test::transformed(mesh, 1e-6, Vector::Zero()), 22);
    expect_what_a_loop_finds(test::transformed(mesh, 1e6, Vector::Zero()), 23);
    expect_what_a_loop_finds(test::transformed(mesh, 1, Vector::Constant(1e6)), 24);
  }
}

TEST(Surface, FindsTrianglesThatMeetFarAwayOrDegenerateOnes) {
  const Surface surface(test::box({0, 0, 0}, {1, 1, 1}));
  std::vector<Index> found{7};
  surface.triangles_overlapping({Point(5, 5, 5), Point(6, 5, 5), Point(5, 6, 5)}, found);
  EXPECT_TRUE(found.empty());
  surface.triangles_overlapping({Point(-1e40, 0.5, 0.5), Point(1e40, 0.5, 0.5), Point(0.5, 1e-30, 0.5)}, found);
  EXPECT_FALSE(found.empty());
  surface.triangles_overlapping({Point(1, 1, 1), Point(1, 1, 1), Point(1, 1, 1)}, found);  // a corner
  EXPECT_GE(found.size(), 3u);
}

}  // namespace
}  // namespace orchard
