// The private parts of relaxation: walking on a surface, the spatial hash, the push of a boundary.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "cell_hash.h"
#include "orchard/geometry/random.h"
#include "sampling/boundary_push.h"
#include "sampling/surface_walk.h"
#include "support/shapes.h"

namespace orchard::detail {
namespace {

constexpr auto kAnywhere = [](Index, Index) { return true; };

void expect_on_triangle(const Surface& surface, const SurfacePoint& point) {
  EXPECT_GE(point.weights.minCoeff(), 0);
  EXPECT_NEAR(point.weights.sum(), 1, 1e-15);
  const auto [a, b, c] = surface.corners(point.triangle);
  EXPECT_LT(closest_point_of_triangle(position(surface, point), a, b, c).distance, 1e-12);
}

TEST(SurfaceWalker, StaysOnTheSurfaceWhateverTheStep) {
  for (const TriangleMesh& mesh :
       {test::box({0, 0, 0}, {1, 1, 1}), test::torus(20, 10), test::icosphere(2), test::open_box(), test::l_shape()}) {
    const Surface surface(mesh);
    const SurfaceWalker walker(surface);
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      Random random(seed, 1);
      SurfacePoint point{static_cast<Index>(random.below(mesh.triangles.size())), Vector(1, 1, 1) / 3};
      if (seed % 3 == 0) point.weights = Vector(1, 0, 0);
      if (seed % 3 == 1) point.weights = Vector(0.5, 0.5, 0);
      const Vector wish(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Vector& normal = surface.normal(point.triangle);
      walker.walk(point, 3 * (wish - wish.dot(normal) * normal), kAnywhere);
      expect_on_triangle(surface, point);
    }
  }
}

TEST(SurfaceWalker, CrossesCoplanarTrianglesInAStraightLine) {
  // A square of 2 * 8 * 8 triangles.
  TriangleMesh mesh;
  for (Index i = 0; i <= 8; ++i)
    for (Index j = 0; j <= 8; ++j) mesh.vertices.emplace_back(i, j, 0);
  for (Index i = 0; i < 8; ++i)
    for (Index j = 0; j < 8; ++j) {
      const Index a = 9 * i + j, b = a + 9;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  const Surface surface(mesh);
  const SurfaceWalker walker(surface);
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed, 2);
    SurfacePoint point{static_cast<Index>(random.below(128)), Vector(0.2, 0.3, 0.5)};
    const Point start = position(surface, point);
    const Vector step(random.uniform(-9, 9), random.uniform(-9, 9), 0);
    walker.walk(point, step, kAnywhere);
    // Where it ends, or where it leaves the square.
    double reached = 1;
    for (int axis = 0; axis < 2; ++axis)
      reached = std::min(reached, ((step[axis] > 0 ? 8 : 0) - start[axis]) / step[axis]);
    EXPECT_LT((position(surface, point) - (start + reached * step)).norm(), 1e-12) << "seed " << seed;
  }
}

TEST(SurfaceWalker, UnfoldsTheStepAcrossEdges) {
  // Once around a box through the middle of four faces is back at the start.
  const Surface surface(test::box({0, 0, 0}, {1, 1, 1}));
  const SurfaceWalker walker(surface);
  for (Index t = 0; t < 12; ++t) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vector along = Vector::Unit(axis);
      if (surface.normal(t).dot(along) != 0) continue;
      SurfacePoint point{t, Vector(0.3, 0.25, 0.45)};
      const Point start = position(surface, point);
      walker.walk(point, 4 * along, kAnywhere);
      EXPECT_LT((position(surface, point) - start).norm(), 1e-14);
      walker.walk(point, 1.5 * along, kAnywhere);
      EXPECT_GT((position(surface, point) - start).norm(), 0.4);
    }
  }
}

TEST(SurfaceWalker, EndsWhereItMayNotCross) {
  const Surface surface(test::box({0, 0, 0}, {1, 1, 1}));
  const Clusters& clusters = surface.clusters();
  for (Index t = 0; t < 12; ++t) {
    SurfacePoint point{t, Vector(0.4, 0.3, 0.3)};
    const auto p = surface.corners(t);
    SurfaceWalker(surface).walk(point, 10 * (p[1] - p[0]) + 3 * (p[2] - p[0]),
                                [&](Index a, Index b) { return clusters.of_triangle[a] == clusters.of_triangle[b]; });
    EXPECT_EQ(clusters.of_triangle[point.triangle], clusters.of_triangle[t]);
    EXPECT_EQ(point.weights.minCoeff(), 0);
    expect_on_triangle(surface, point);
  }
}

TEST(BoundaryPush, IsTheMeanFieldOfAHalfPlane) {
  const BoundaryPush push;
  EXPECT_NEAR(push.of_area(0), 1.0 / 3, 1e-4);  // exact integral
  EXPECT_EQ(push.of_area(1), 0);
  EXPECT_EQ(push.of_line(1), 0);
  // A sum over a fine lattice.
  for (const double h : {0.1, 0.35, 0.6, 0.9}) {
    double area = 0, line = 0;
    const double d = 1e-3;
    for (double y = -1 + d / 2; y < 1; y += d) {
      line += std::max(0.0, 1 - std::hypot(h, y)) * h / std::hypot(h, y) * d;
      for (double x = h + d / 2; x < 1; x += d)
        area += std::max(0.0, 1 - std::hypot(x, y)) * x / std::hypot(x, y) * d * d;
    }
    EXPECT_NEAR(push.of_area(h), area, 2e-3) << h;
    EXPECT_NEAR(push.of_line(h), line, 5e-3) << h;
  }
}

TEST(CellHash, FindsWhatABruteForceSearchFinds) {
  for (const double extent : {1.0, 1e4, 1e8}) {  // crowded to sparse
    std::vector<Point> points;
    Random random(3, 4);
    for (int i = 0; i < 500; ++i)
      points.emplace_back(extent * random.uniform(-1, 1), extent * random.uniform(-1, 1),
                          extent * random.uniform(-1, 1));
    points.resize(600, points[7]);
    CellHash hash(Point(0.1, 0.2, 0.3), 0.25 * extent);
    std::vector<Cell> cells;
    for (const Point& p : points) cells.push_back(hash.cell_of(p));
    hash.build(cells);
    for (Index i = 0; i < points.size(); ++i) {
      std::vector<Index> found, expected;
      hash.visit_block(cells[i], 3, [&](Index j) { found.push_back(j); });
      for (Index j = 0; j < points.size(); ++j)
        if (std::abs(cells[i].x - cells[j].x) <= 1 && std::abs(cells[i].y - cells[j].y) <= 1 &&
            std::abs(cells[i].z - cells[j].z) <= 1)
          expected.push_back(j);
      std::ranges::sort(found);
      EXPECT_EQ(found, expected);
      std::vector<Index> same;
      hash.visit(cells[i], [&](Index j) { same.push_back(j); });
      EXPECT_TRUE(std::ranges::is_sorted(same));
    }
    const std::vector<Index> runs = hash.runs();
    std::vector<bool> seen(points.size(), false);
    for (std::size_t r = 0; r + 1 < runs.size(); ++r)
      for (Index e = runs[r]; e < runs[r + 1]; ++e) {
        EXPECT_EQ(hash.entry(e).cell, hash.entry(runs[r]).cell);
        EXPECT_FALSE(seen[hash.entry(e).item]);
        seen[hash.entry(e).item] = true;
      }
    EXPECT_EQ(std::ranges::count(seen, false), 0);
  }
}

}  // namespace
}  // namespace orchard::detail
