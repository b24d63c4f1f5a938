#include "orchard/voronoi/views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <ranges>
#include <set>

#include "orchard/voronoi/exact.h"
#include "orchard/voronoi/highest_first.h"
#include "voronoi/algorithms/count_allocations.h"
#include "voronoi/point_sets.h"

namespace orchard {
namespace {

static_assert(std::ranges::input_range<VoronoiFace>);
static_assert(std::ranges::input_range<VoronoiFaceRange>);
static_assert(std::ranges::input_range<VoronoiEdges>);

std::vector<Index> listed(const VoronoiFace& face) {
  std::vector<Index> vertices;
  for (const Index v : face) vertices.push_back(v);
  return vertices;
}

// Starting with its lowest.
std::vector<Index> rotated(std::span<const Index> ring) {
  std::vector<Index> result(ring.begin(), ring.end());
  std::rotate(result.begin(), std::min_element(result.begin(), result.end()), result.end());
  return result;
}

TEST(VoronoiViews, OfFacesAreTheArraysInAnotherOrder) {
  for (const auto& points : {test::uniform_points(300, 1), test::torus_points(300, 2), test::grid_points(5)}) {
    const VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
    const VoronoiFaces expected = voronoi_faces(diagram);
    std::map<std::array<Index, 2>, std::vector<Index>> found;
    for (const VoronoiFace& face : faces(diagram)) {
      const bool fresh = found.emplace(std::array{face.first_point(), face.second_point()}, listed(face)).second;
      EXPECT_TRUE(fresh) << "a face came twice";
    }
    ASSERT_EQ(found.size(), expected.points.size());
    for (Index f = 0; f < expected.vertices.size(); ++f) {
      const auto& ring = found.at(expected.points[f]);
      EXPECT_EQ(rotated(ring), rotated(expected.vertices[f]));
      EXPECT_EQ(ring.front(), *std::min_element(ring.begin(), ring.end()));
    }
  }
}

TEST(VoronoiViews, OfEdgesListEachPairOfNeighboursOnce) {
  const VoronoiDiagram diagram = highest_first_voronoi(test::bumpy_sphere_points(200, 3)).diagram;
  std::set<std::array<Index, 2>> found;
  for (const VoronoiEdge& edge : edges(diagram)) {
    EXPECT_LT(edge.vertices[0], edge.vertices[1]);
    EXPECT_TRUE(found.insert(edge.vertices).second);
    for (const Index end : edge.vertices)
      for (const Index point : edge.points) {
        const auto& corner = diagram.vertices[end].forming_points;
        EXPECT_NE(std::find(corner.begin(), corner.end(), point), corner.end());
      }
  }
  EXPECT_EQ(found.size(), 2 * diagram.vertices.size());  // four neighbours each
}

TEST(VoronoiViews, OfCellsHoldTheFacesTowardsAllNeighbours) {
  test::Points points = test::uniform_points(200, 4);
  points.push_back(points[0]);
  const VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
  const VoronoiCells cells(diagram);
  ASSERT_EQ(cells.size(), points.size());
  std::map<Index, std::map<Index, std::vector<Index>>> expected;
  for (const VoronoiFace& face : faces(diagram)) {
    std::vector<Index> ring = listed(face);
    expected[face.first_point()][face.second_point()] = rotated(ring);
    std::reverse(ring.begin(), ring.end());
    expected[face.second_point()][face.first_point()] = rotated(ring);
  }
  for (Index p = 0; p < cells.size(); ++p) {
    std::map<Index, std::vector<Index>> found;
    for (const VoronoiFace& face : cells.faces(p)) {
      EXPECT_EQ(face.first_point(), p);
      EXPECT_TRUE(found.emplace(face.second_point(), rotated(listed(face))).second);
    }
    EXPECT_EQ(found, expected[p]);
  }
  EXPECT_TRUE(cells.vertices(200).empty());
  EXPECT_EQ(std::ranges::distance(cells.faces(200)), 0);
}

TEST(VoronoiViews, TellBoundedCells) {
  const VoronoiDiagram diagram = exact_voronoi(test::grid_points(4)).diagram;
  const VoronoiCells cells(diagram);
  int bounded = 0;
  for (Index p = 0; p < cells.size(); ++p) bounded += cells.bounded(p);
  EXPECT_EQ(bounded, 8);
}

TEST(VoronoiViews, AllocateNothing) {
  const VoronoiDiagram diagram = highest_first_voronoi(test::torus_points(300, 5)).diagram;
  const VoronoiCells cells(diagram);
  const std::size_t before = test::allocations();
  std::size_t seen = 0;
  for (const VoronoiEdge& edge : edges(diagram)) seen += edge.vertices[0];
  for (const VoronoiFace& face : faces(diagram))
    for (const Index v : face) seen += v;
  for (Index p = 0; p < cells.size(); ++p)
    for (const VoronoiFace& face : cells.faces(p))
      for (const Index v : face) seen += v + cells.vertices(p).size();
  EXPECT_EQ(test::allocations(), before);
  EXPECT_GT(seen, 0u);
}

TEST(VoronoiViews, OfADiagramWithoutVerticesAreEmpty) {
  const VoronoiDiagram diagram = highest_first_voronoi(test::Points{{0, 0, 0}, {1, 0, 0}}).diagram;
  EXPECT_EQ(std::ranges::distance(edges(diagram)), 0);
  EXPECT_EQ(std::ranges::distance(faces(diagram)), 0);
  EXPECT_EQ(std::ranges::distance(VoronoiCells(diagram).faces(0)), 0);
}

}  // namespace
}  // namespace orchard
