#include "orchard/voronoi/cell_polyhedron.h"

#include <gtest/gtest.h>

#include <map>

#include "orchard/geometry/random.h"
#include "orchard/voronoi/highest_first.h"
#include "voronoi/point_sets.h"

namespace orchard {
namespace {

Box box_around(const test::Points& points, double margin) {
  Box box;
  for (const Point& p : points) box.extend(p);
  const Vector more = Vector::Constant(margin);
  return {box.min() - more, box.max() + more};
}

TEST(ClippedCell, OfAllPointsFillTheBox) {
  for (const auto& [name, points] : test::degenerate_point_sets()) {
    const Box box = box_around(points, 0.1);
    if (name == "needle" || name == "two distant clusters" || name.starts_with("tiny") || name.starts_with("grid far"))
      continue;
    const VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
    const VoronoiCells cells(diagram);
    double sum = 0;
    for (Index p = 0; p < cells.size(); ++p) sum += volume(clipped_cell(diagram, cells, p, box));
    EXPECT_NEAR(sum, box.volume(), 1e-9 * box.volume()) << name;
  }
}

TEST(ClippedCell, IsClosedAndConvexAndHoldsItsPoint) {
  const test::Points points = test::bumpy_sphere_points(200, 1);
  const VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
  const VoronoiCells cells(diagram);
  const Box box = box_around(points, 0.5);
  for (Index p = 0; p < cells.size(); ++p) {
    const CellPolyhedron cell = clipped_cell(diagram, cells, p, box);
    std::map<std::pair<Index, Index>, int> edges;
    ASSERT_EQ(cell.neighbors.size(), cell.faces.size());
    for (Index f = 0; f < cell.faces.size(); ++f) {
      const auto ring = cell.faces[f];
      Vector normal = Vector::Zero();
      for (std::size_t i = 0; i < ring.size(); ++i) {
        ++edges[{ring[i], ring[(i + 1) % ring.size()]}];
        if (i > 0 && i + 1 < ring.size())
          normal +=
              (cell.corners[ring[i]] - cell.corners[ring[0]]).cross(cell.corners[ring[i + 1]] - cell.corners[ring[0]]);
      }
      for (const Point& corner : cell.corners)
        EXPECT_LT((corner - cell.corners[ring[0]]).dot(normal), 1e-9) << "not convex";
      EXPECT_LT((points[p] - cell.corners[ring[0]]).dot(normal), 1e-12) << "the point is outside";
      if (cell.neighbors[f] == kNone) continue;
      for (const Index corner : ring)
        EXPECT_NEAR((cell.corners[corner] - points[p]).norm(),
                    (cell.corners[corner] - points[cell.neighbors[f]]).norm(), 1e-9);
    }
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ((edges.count({edge.second, edge.first})), 1u) << "not closed";
    }
  }
}

test::Points unit_lattice() {
  test::Points points;
  for (int i = 0; i < 64; ++i) points.emplace_back(i % 4, i / 4 % 4, i / 16);
  return points;
}

TEST(ClippedCell, OfALatticeAreItsCubes) {
  const VoronoiDiagram diagram = highest_first_voronoi(unit_lattice()).diagram;
  const VoronoiCells cells(diagram);
  const Box box(Point(-0.5, -0.5, -0.5), Point(3.5, 3.5, 3.5));
  for (Index p = 0; p < cells.size(); ++p) {
    const CellPolyhedron cell = clipped_cell(diagram, cells, p, box);
    EXPECT_NEAR(volume(cell), 1, 1e-12);
    EXPECT_EQ(cell.faces.size(), 6u);
    EXPECT_EQ(cell.corners.size(), 8u);
  }
}

TEST(ClippedCell, IsEmptyOutsideTheBoxAndForPointsWithoutVertices) {
  test::Points points = unit_lattice();
  points.push_back(points[0]);
  const VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
  const VoronoiCells cells(diagram);
  const Box corner(Point(-1, -1, -1), Point(0.4, 0.4, 0.4));
  EXPECT_NEAR(volume(clipped_cell(diagram, cells, 0, corner)), corner.volume(), 1e-12);
  for (Index p = 1; p < cells.size(); ++p) EXPECT_TRUE(clipped_cell(diagram, cells, p, corner).corners.empty());
  EXPECT_TRUE(clipped_cell(diagram, cells, 0, Box()).corners.empty());
}

}  // namespace
}  // namespace orchard
