#include "gaps/restricted_voronoi.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gaps/cell_components.h"
#include "gaps/joined_inside.h"
#include "orchard/geometry/random.h"
#include "orchard/voronoi/exact.h"
#include "support/shapes.h"

namespace orchard::detail {
namespace {

double area_of(const CellPolygon& polygon) {
  Vector area = Vector::Zero();
  for (std::size_t i = 2; i < polygon.corners.size(); ++i) {
    area += (polygon.corners[i - 1] - polygon.corners[0]).cross(polygon.corners[i] - polygon.corners[0]);
  }
  return 0.5 * area.norm();
}

Point random_point(const Surface& surface, Index triangle, Random& random) {
  const auto [a, b, c] = surface.corners(triangle);
  const double u = std::sqrt(random.uniform()), v = random.uniform();
  return (1 - u) * a + u * (1 - v) * b + u * v * c;
}

SurfaceSampling random_sampling(const Surface& surface, Index count, std::uint64_t seed) {
  SurfaceSampling sampling;
  for (Index i = 0; i < count; ++i) {
    Random random(seed, 5, i);
    const Index triangle = static_cast<Index>(random.below(surface.mesh().triangles.size()));
    sampling.points.push_back(random_point(surface, triangle, random));
    sampling.triangles.push_back(triangle);
    sampling.features.push_back(Feature::face);
    sampling.origins.push_back(PointOrigin::face);
  }
  return sampling;
}

Index nearest_by_brute_force(const std::vector<Point>& points, const Point& query) {
  Index nearest = 0;
  for (Index i = 1; i < points.size(); ++i) {
    if ((points[i] - query).squaredNorm() < (points[nearest] - query).squaredNorm()) nearest = i;
  }
  return nearest;
}

std::vector<TriangleMesh> solid_meshes() {
  return {test::box({0, 0, 0}, {1, 2, 3}), test::u_shape(0.05), test::torus(16, 8), test::two_boxes(0.01)};
}

TEST(RestrictedVoronoi, DividesEveryTriangleAmongItsNearestPoints) {
  std::uint64_t seed = 0;
  for (const TriangleMesh& mesh : solid_meshes()) {
    SCOPED_TRACE(++seed);
    const Surface surface(mesh);
    const SurfaceSampling sampling = random_sampling(surface, 300, seed);
    const VoronoiDiagram diagram = exact_voronoi(sampling.points).diagram;
    const CellNeighbors neighbors(diagram);
    const RestrictedVoronoi restricted(surface, diagram.points, neighbors);
    CellPolygon polygon;
    for (Index triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
      double area = 0;
      for (const CellPiece& piece : restricted.pieces(triangle)) {
        restricted.polygon(triangle, piece.cell, polygon);
        area += area_of(polygon);
      }
      EXPECT_NEAR(area, surface.area(triangle), 1e-6 * surface.area(triangle));
      Random random(seed, 6, triangle);
      for (int k = 0; k < 10; ++k) {
        const Point query = random_point(surface, triangle, random);
        EXPECT_NE(restricted.piece(triangle, nearest_by_brute_force(sampling.points, query)), nullptr);
      }
    }
  }
}

TEST(RestrictedVoronoi, BordersAreMutual) {
  for (const TriangleMesh& mesh : solid_meshes()) {
    const Surface surface(mesh);
    const SurfaceSampling sampling = random_sampling(surface, 200, 9);
    const VoronoiDiagram diagram = exact_voronoi(sampling.points).diagram;
    const CellNeighbors neighbors(diagram);
    const RestrictedVoronoi restricted(surface, diagram.points, neighbors);
    for (Index triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
      for (const CellPiece& piece : restricted.pieces(triangle)) {
        for (const CellBorder& border : piece.borders) {
          const CellPiece* other = restricted.piece(triangle, border.cell);
          ASSERT_NE(other, nullptr);
          EXPECT_TRUE(std::any_of(other->borders.begin(), other->borders.end(),
                                  [&](const CellBorder& back) { return back.cell == piece.cell; }));
        }
      }
    }
  }
}

TEST(RestrictedVoronoi, UpdatesToWhatItWouldHaveBeen) {
  std::uint64_t seed = 100;
  for (const TriangleMesh& mesh : solid_meshes()) {
    SCOPED_TRACE(++seed);
    const Surface surface(mesh);
    const SurfaceSampling all = random_sampling(surface, 260, seed);
    const Index first_new = 240;
    VoronoiDiagram diagram = exact_voronoi(std::span(all.points).first(first_new)).diagram;
    CellNeighbors neighbors(diagram);
    RestrictedVoronoi updated(surface, diagram.points, neighbors);
    const VoronoiDiagram larger = exact_voronoi(all.points).diagram;
    updated.update(larger.points, neighbors.update(larger, first_new));
    const CellNeighbors fresh_neighbors(larger);
    const RestrictedVoronoi fresh(surface, larger.points, fresh_neighbors);
    for (Index point = 0; point < all.size(); ++point) {
      EXPECT_TRUE(std::equal(neighbors[point].begin(), neighbors[point].end(), fresh_neighbors[point].begin(),
                             fresh_neighbors[point].end()));
    }
    for (Index triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
      ASSERT_EQ(updated.pieces(triangle).size(), fresh.pieces(triangle).size());
      for (std::size_t k = 0; k < fresh.pieces(triangle).size(); ++k) {
        const CellPiece &a = updated.pieces(triangle)[k], &b = fresh.pieces(triangle)[k];
        EXPECT_EQ(a.cell, b.cell);
        EXPECT_EQ(a.edges, b.edges);
        EXPECT_EQ(a.borders.size(), b.borders.size());
      }
    }
  }
}

TEST(CellPatches, AddUpToTheEulerCharacteristicOfTheSurface) {
  // Components are faces, their common borders arcs and the points where three meet vertices of a division of the
  // surface; when all are disks, the triangles of their dual count it as well.
  for (const auto& [mesh, characteristic] :
       std::vector<std::pair<TriangleMesh, int>>{{test::icosphere(3), 2}, {test::torus(48, 24), 0}}) {
    const Surface surface(mesh);
    const SurfaceSampling sampling = sample_surface(surface, {.face_points = 600, .edge_points = 0});
    const VoronoiDiagram diagram = exact_voronoi(sampling.points).diagram;
    const CellNeighbors neighbors(diagram);
    const RestrictedVoronoi restricted(surface, diagram.points, neighbors);
    const auto components =
        find_cell_components(surface, sampling, restricted, ComponentScope::everything(surface, sampling));
    ASSERT_EQ(components.size(), sampling.size());
    std::size_t ends = 0;
    for (const CellComponent& component : components) {
      EXPECT_TRUE(component.home);
      EXPECT_EQ(component.euler_characteristic, 1);
      std::vector<Index> others;
      for (const Index triangle : component.triangles) {
        for (const CellBorder& border : restricted.piece(triangle, component.cell)->borders)
          others.push_back(border.cell);
      }
      std::sort(others.begin(), others.end());
      ends += static_cast<std::size_t>(std::unique(others.begin(), others.end()) - others.begin());
    }
    // In a triangulation 3 F = 2 E, so V - E + F = V - E / 3, where E = ends / 2.
    EXPECT_EQ(6 * static_cast<int>(components.size()) - static_cast<int>(ends), 6 * characteristic);
  }
}

TEST(CellPatches, TellOneThatTheCellReachesFromOneThatItsPointLiesOn) {
  const Surface surface(test::two_boxes(0.1));
  // One point on a side that faces the gap, and none on the other: it reaches across.
  const SurfaceSampling all = sample_surface(surface, {.face_points = 400, .edge_points = 100});
  const double middle = surface.bounding_box().center().x();
  SurfaceSampling some;
  for (Index i = 0; i < all.size(); ++i) {
    if (all.points[i].x() > middle && all.points[i].x() < middle + 0.2) continue;
    some.points.push_back(all.points[i]);
    some.triangles.push_back(all.triangles[i]);
    some.features.push_back(all.features[i]);
    some.origins.push_back(all.origins[i]);
  }
  const VoronoiDiagram diagram = exact_voronoi(some.points).diagram;
  const CellNeighbors neighbors(diagram);
  const RestrictedVoronoi restricted(surface, diagram.points, neighbors);
  const auto components = find_cell_components(surface, some, restricted, ComponentScope::everything(surface, some));
  Index foreign = 0;
  for (const CellComponent& component : components) {
    if (component.home) continue;
    ++foreign;
    EXPECT_LT(some.points[component.cell].x(), middle);
    for (const Index triangle : component.triangles) EXPECT_GT(surface.corners(triangle)[0].x(), middle);
  }
  EXPECT_GT(foreign, 10u);
}

TEST(JoinedInside, FollowsTheSurfaceWithinTheBallOnly) {
  const Surface surface(test::u_shape(0.1));
  SurfaceSampling sampling;  // on the two sides of the gap, at half height
  for (const double x : {1.45, 1.55}) {
    const ClosestPoint place = surface.closest({x, 1.5, 0.5});
    sampling.points.push_back(place.position);
    sampling.triangles.push_back(place.triangle);
    sampling.features.push_back(place.feature);
    sampling.origins.push_back(PointOrigin::face);
  }
  const std::array<Index, 1> from{sampling.triangles[0]};
  const Point middle = 0.5 * (sampling.points[0] + sampling.points[1]);
  EXPECT_FALSE(joined_inside(surface, sampling, {middle, 0.1}, from, {0, 1}));
  EXPECT_TRUE(joined_inside(surface, sampling, {middle, 5}, from, {0, 1}));
  EXPECT_TRUE(joined_inside(surface, sampling, {middle, 0.1}, from, {0, 0}));
}

}  // namespace
}  // namespace orchard::detail
