#include "orchard/voronoi/exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "voronoi/point_sets.h"

namespace orchard {
namespace {

using Four = std::array<Index, 4>;

// Six times the volume, and the signed power of the last point, by the determinants; long double keeps small random
// cases away from round-off.
long double orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  using V = Eigen::Matrix<long double, 3, 1>;
  const V origin = a.cast<long double>();
  const V u = b.cast<long double>() - origin, v = c.cast<long double>() - origin, w = d.cast<long double>() - origin;
  return u.cross(v).dot(w);
}

bool inside_sphere(const std::array<Point, 4>& p, const Point& q) {
  Eigen::Matrix<long double, 4, 4> m;
  for (int i = 0; i < 4; ++i) {
    const auto d = (p[static_cast<std::size_t>(i)] - q).cast<long double>().eval();
    m.row(i) << d.x(), d.y(), d.z(), d.squaredNorm();
  }
  const long double sign = orientation(p[0], p[1], p[2], p[3]) > 0 ? 1 : -1;
  return sign * m.determinant() < 0;  // the rows p - q make the lifted orientation negative for points inside
}

// Every quadruple whose sphere is empty, by trying all of them.
std::set<Four> brute_force(const test::Points& points) {
  std::set<Four> result;
  const auto n = static_cast<Index>(points.size());
  for (Index a = 0; a < n; ++a)
    for (Index b = a + 1; b < n; ++b)
      for (Index c = b + 1; c < n; ++c)
        for (Index d = c + 1; d < n; ++d) {
          bool empty = true;
          for (Index q = 0; q < n && empty; ++q)
            if (q != a && q != b && q != c && q != d)
              empty = !inside_sphere({points[a], points[b], points[c], points[d]}, points[q]);
          if (empty) result.insert({a, b, c, d});
        }
  return result;
}

TEST(ExactVoronoi, HasTheVerticesWhoseSpheresHoldNoPoint) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const test::Points points = test::uniform_points(5 + seed % 10, seed);
    const VoronoiDiagram diagram = exact_voronoi(points).diagram;
    validate(diagram);
    std::set<Four> found;
    for (const VoronoiVertex& vertex : diagram.vertices) {
      Four key = vertex.forming_points;
      std::sort(key.begin(), key.end());
      if (!vertex.at_infinity()) found.insert(key);
    }
    EXPECT_EQ(found, brute_force(points)) << "seed " << seed;
  }
}

TEST(ExactVoronoi, PlacesVerticesAtEqualDistanceFromTheirFormingPoints) {
  for (const auto& [name, points] : test::degenerate_point_sets()) {
    const VoronoiDiagram diagram = exact_voronoi(points).diagram;
    validate(diagram);
    const Box box = [&p = points] {
      Box b;
      for (const Point& q : p) b.extend(q);
      return b;
    }();
    for (const VoronoiVertex& vertex : diagram.vertices) {
      if (vertex.at_infinity()) continue;
      const double slack = 1e-14 * (vertex.radius + box.diagonal().norm() + box.max().cwiseAbs().maxCoeff());
      for (Index p : vertex.forming_points)
        EXPECT_NEAR((points[p] - vertex.center).norm(), vertex.radius, slack) << name;
    }
  }
}

TEST(ExactVoronoi, PointsUnboundedEdgesAwayFromAllPoints) {
  const test::Points points = test::torus_points(200, 1);
  for (const VoronoiVertex& vertex : exact_voronoi(points).diagram.vertices) {
    if (!vertex.at_infinity()) continue;
    EXPECT_NEAR(vertex.center.norm(), 1, 1e-14);
    const Index on = vertex.forming_points[0] == kInfinitePoint ? vertex.forming_points[1] : vertex.forming_points[0];
    for (const Point& p : points) EXPECT_LT((p - points[on]).dot(vertex.center), 1e-12);
  }
}

// Neither products of large or small coordinates nor hulls that are almost an edge cost a position.
TEST(ExactVoronoi, PlacesVerticesAtEverySizeAndOfNeedles) {
  const test::Points usual = test::uniform_points(40, 3);
  const VoronoiDiagram expected = exact_voronoi(usual).diagram;
  for (const int exponent : {-325, -200, 200, 325}) {
    const double scale = std::ldexp(1.0, exponent);
    const VoronoiDiagram diagram = exact_voronoi(test::moved(usual, scale, Vector::Zero())).diagram;
    ASSERT_EQ(diagram.vertices.size(), expected.vertices.size());
    for (std::size_t v = 0; v < expected.vertices.size(); ++v) {
      const VoronoiVertex &vertex = diagram.vertices[v], &same = expected.vertices[v];
      ASSERT_EQ(vertex.forming_points, same.forming_points);
      ASSERT_EQ(vertex.center, same.at_infinity() ? same.center : Point(scale * same.center)) << exponent;
      ASSERT_EQ(vertex.radius, scale * same.radius) << exponent;
    }
  }
  test::Points needle;  // three columns, the points of each on a line but for roundings
  for (int i = 0; i < 12; ++i) {
    const double a = 2 * M_PI * (i % 3) / 3;
    needle.push_back({1 + std::cos(a) + 4e-16 * (i / 3 % 2), std::sin(a), i / 3.0});
  }
  for (const VoronoiVertex& vertex : exact_voronoi(needle).diagram.vertices) {
    if (vertex.at_infinity()) {
      EXPECT_NEAR(vertex.center.norm(), 1, 1e-14);
    }
  }
}

TEST(ExactVoronoi, LeavesOutCoincidentPointsButTheFirst) {
  test::Points points = test::uniform_points(40, 1);
  points.push_back(points[7]);
  points.insert(points.begin(), points[5]);
  const Rows rows = vertices_of_points(exact_voronoi(points).diagram);
  EXPECT_TRUE(rows[41].empty());
  EXPECT_TRUE(rows[6].empty());
  EXPECT_FALSE(rows[0].empty());
  EXPECT_FALSE(rows[8].empty());
}

TEST(ExactVoronoi, OfPointsInAPlaneHasNoVertices) {
  const std::vector<std::pair<int, test::Points>> flat{{0, {}},
                                                       {0, {{1, 2, 3}, {1, 2, 3}}},
                                                       {1, {{0, 0, 0}, {1, 1, 0}, {3, 3, 0}, {2, 2, 0}, {5, 5, 0}}},
                                                       {2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                                                       {2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}}};
  for (const auto& [dimension, points] : flat) {
    const auto [diagram, report] = exact_voronoi(points);
    EXPECT_TRUE(diagram.vertices.empty());
    EXPECT_EQ(report.dimension, dimension);
  }
}

}  // namespace
}  // namespace orchard
