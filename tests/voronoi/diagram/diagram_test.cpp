#include "orchard/voronoi/diagram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "orchard/geometry/error.h"
#include "orchard/voronoi/exact.h"
#include "voronoi/point_sets.h"

namespace orchard {
namespace {

bool forms(const VoronoiVertex& vertex, Index point) {
  return std::find(vertex.forming_points.begin(), vertex.forming_points.end(), point) != vertex.forming_points.end();
}

bool neighbors(const VoronoiVertex& vertex, Index other) {
  return std::find(vertex.neighbors.begin(), vertex.neighbors.end(), other) != vertex.neighbors.end();
}

TEST(VoronoiFaces, ListEachPairOfNeighbouringCellsOnceInAscendingOrder) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const VoronoiDiagram diagram = exact_voronoi(test::torus_points(150, seed)).diagram;
    const VoronoiFaces faces = voronoi_faces(diagram);
    std::set<std::array<Index, 2>> expected;
    for (const VoronoiVertex& vertex : diagram.vertices)
      for (Index a : vertex.forming_points)
        for (Index b : vertex.forming_points)
          if (a < b && b != kInfinitePoint) expected.insert({a, b});
    EXPECT_EQ(faces.points, (std::vector<std::array<Index, 2>>(expected.begin(), expected.end()))) << "seed " << seed;
    EXPECT_EQ(faces.vertices.size(), faces.points.size());
  }
}

TEST(VoronoiFaces, GoAroundTheEdgeBetweenTheTwoPoints) {
  const VoronoiDiagram diagram = exact_voronoi(test::uniform_points(300, 3)).diagram;
  const VoronoiFaces faces = voronoi_faces(diagram);
  for (Index f = 0; f < faces.vertices.size(); ++f) {
    const auto ring = faces.vertices[f];
    const auto [a, b] = faces.points[f];
    std::set<Index> distinct(ring.begin(), ring.end()), all;
    for (Index v = 0; v < diagram.vertices.size(); ++v)
      if (forms(diagram.vertices[v], a) && forms(diagram.vertices[v], b)) all.insert(v);
    EXPECT_EQ(distinct, all);
    EXPECT_EQ(distinct.size(), ring.size());
    Index at_infinity = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const VoronoiVertex& vertex = diagram.vertices[ring[i]];
      EXPECT_TRUE(neighbors(vertex, ring[(i + 1) % ring.size()]));
      if (vertex.at_infinity()) ++at_infinity;
    }
    EXPECT_TRUE(at_infinity == 0 || at_infinity == 2);
  }
}

TEST(VoronoiFaces, RunCounterClockwiseSeenFromTheSecondPoint) {
  const VoronoiDiagram diagram = exact_voronoi(test::uniform_points(300, 4)).diagram;
  const VoronoiFaces faces = voronoi_faces(diagram);
  for (Index f = 0; f < faces.vertices.size(); ++f) {
    const auto ring = faces.vertices[f];
    const auto center = [&](std::size_t i) { return diagram.vertices[ring[i % ring.size()]].center; };
    if (std::any_of(ring.begin(), ring.end(), [&](Index v) { return diagram.vertices[v].at_infinity(); })) continue;
    Vector area = Vector::Zero();
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) area += (center(i) - center(0)).cross(center(i + 1) - center(0));
    EXPECT_GT(area.dot(diagram.points[faces.points[f][1]] - diagram.points[faces.points[f][0]]), 0);
  }
}

TEST(VerticesOfPoints, AreAscendingAndComplete) {
  const VoronoiDiagram diagram = exact_voronoi(test::uniform_points(200, 5)).diagram;
  const Rows rows = vertices_of_points(diagram);
  ASSERT_EQ(rows.size(), diagram.points.size());
  for (Index p = 0; p < rows.size(); ++p) {
    std::vector<Index> expected;
    for (Index v = 0; v < diagram.vertices.size(); ++v)
      if (forms(diagram.vertices[v], p)) expected.push_back(v);
    EXPECT_EQ(std::vector<Index>(rows[p].begin(), rows[p].end()), expected);
  }
}

TEST(Validate, AcceptsAnEmptyDiagram) { EXPECT_NO_THROW(validate(VoronoiDiagram{})); }

TEST(Validate, NoticesWhatIsBroken) {
  const VoronoiDiagram good = exact_voronoi(test::uniform_points(60, 6)).diagram;
  ASSERT_NO_THROW(validate(good));
  const auto refuses = [&](const char* what, auto&& damage) {
    VoronoiDiagram bad = good;
    damage(bad);
    EXPECT_THROW(validate(bad), Error) << what;
  };
  refuses("index of a point", [](VoronoiDiagram& d) { d.vertices[3].forming_points[1] = 60; });
  refuses("index of a neighbour",
          [](VoronoiDiagram& d) { d.vertices[3].neighbors[1] = static_cast<Index>(d.vertices.size()); });
  refuses("a point twice",
          [](VoronoiDiagram& d) { d.vertices[3].forming_points[1] = d.vertices[3].forming_points[2]; });
  refuses("neighbours exchanged",
          [](VoronoiDiagram& d) { std::swap(d.vertices[3].neighbors[0], d.vertices[3].neighbors[1]); });
  refuses("orientation", [](VoronoiDiagram& d) {
    std::swap(d.vertices[3].forming_points[0], d.vertices[3].forming_points[1]);
    std::swap(d.vertices[3].neighbors[0], d.vertices[3].neighbors[1]);
  });
  refuses("one neighbour is wrong", [](VoronoiDiagram& d) { d.vertices[3].neighbors[0] = d.vertices[3].neighbors[1]; });
  refuses("two diagrams in one", [&](VoronoiDiagram& d) {
    const auto shift = static_cast<Index>(d.vertices.size());
    for (VoronoiVertex vertex : good.vertices) {
      for (Index& n : vertex.neighbors) n += shift;
      d.vertices.push_back(vertex);
    }
  });
  refuses("two points made one", [](VoronoiDiagram& d) {
    for (VoronoiVertex& vertex : d.vertices)
      for (Index& p : vertex.forming_points)
        if (p == 1) p = 0;
  });
}

}  // namespace
}  // namespace orchard
