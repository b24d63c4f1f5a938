#include "gaps/repair_point.h"

#include <gtest/gtest.h>

#include "gaps/neck_test.h"
#include "gaps/valley_bottom.h"
#include "orchard/voronoi/exact.h"
#include "outlines.h"
#include "support/shapes.h"

namespace orchard::detail {
namespace {

void add_point(const Surface& surface, SurfaceSampling& sampling, const Point& near) {
  const ClosestPoint place = surface.closest(near);
  sampling.points.push_back(place.position);
  sampling.triangles.push_back(place.triangle);
  sampling.features.push_back(place.feature);
  sampling.origins.push_back(PointOrigin::face);
}

// What is wrong with the cell of the first of a few points.
struct Scene {
  explicit Scene(TriangleMesh mesh) : surface(std::move(mesh)) {}

  void prepare() {
    diagram = exact_voronoi(sampling.points).diagram;
    neighbors.emplace(diagram);
    restricted.emplace(surface, diagram.points, *neighbors);
    for (Crossing& crossing :
         find_crossings(surface, sampling, *restricted, ComponentScope::everything(surface, sampling), {})) {
      if (crossing.component.cell == 0) crossings.push_back(std::move(crossing));
    }
  }

  Surface surface;
  SurfaceSampling sampling;
  VoronoiDiagram diagram;
  std::optional<CellNeighbors> neighbors;
  std::optional<RestrictedVoronoi> restricted;
  std::vector<Crossing> crossings;
};

TEST(RepairPoint, LiesStraightAcrossAGapBetweenParallelSides) {
  Scene scene(test::two_boxes(0.1));
  const Box& box = scene.surface.bounding_box();
  const Point inner = scene.surface.closest(box.center() + Vector(-0.01, 0.05, 0.02)).position;
  add_point(scene.surface, scene.sampling, inner);
  for (int corner = 0; corner < 8; ++corner) {
    add_point(scene.surface, scene.sampling, box.corner(static_cast<Box::CornerType>(corner)));
  }
  scene.prepare();
  bool found = false;
  for (const Crossing& crossing : scene.crossings) {
    if (crossing.neck) continue;
    const RepairProposal proposal = propose_repair(scene.surface, scene.sampling, *scene.restricted, crossing, false);
    if (proposal.facing.empty() || proposal.facing[0].distance > 0.11) continue;
    found = true;
    EXPECT_NEAR((proposal.facing[0].position - inner - Vector(0.1, 0, 0)).norm(), 0, 1e-9);
  }
  EXPECT_TRUE(found);
}

TEST(RepairPoint, LiesAsDeepInAVAsThePointDoes) {
  Scene scene(test::extruded(test::v_groove(0.4), 1));
  // The V's sides meet in (1.5, 0.3) and are mirror images of each other.
  add_point(scene.surface, scene.sampling, {1.5 - 0.1, 1.2, 0.5});
  for (const double x : {0.0, 3.0}) {
    for (const double y : {0.0, 2.0}) {
      for (const double z : {0.0, 1.0}) add_point(scene.surface, scene.sampling, {x, y, z});
    }
  }
  add_point(scene.surface, scene.sampling, {1.5, 0.3, 0.5});
  scene.prepare();
  const Point from = scene.sampling.points[0];
  bool found = false;
  for (const Crossing& crossing : scene.crossings) {
    if (crossing.neck) continue;
    for (const ClosestPoint& place :
         propose_repair(scene.surface, scene.sampling, *scene.restricted, crossing, false).facing) {
      found = found || (place.position - Point(3 - from.x(), from.y(), from.z())).norm() < 1e-9;
    }
  }
  EXPECT_TRUE(found);
}

TEST(RepairPoint, NeverFloats) {
  Scene scene(test::extruded(test::short_shelf(0.05), 1));
  const SurfaceSampling some = sample_surface(scene.surface, {.face_points = 150, .edge_points = 40});
  scene.sampling = some;
  scene.diagram = exact_voronoi(some.points).diagram;
  scene.neighbors.emplace(scene.diagram);
  scene.restricted.emplace(scene.surface, scene.diagram.points, *scene.neighbors);
  const auto crossings =
      find_crossings(scene.surface, some, *scene.restricted, ComponentScope::everything(scene.surface, some), {});
  ASSERT_FALSE(crossings.empty());
  for (const Crossing& crossing : crossings) {
    for (const bool bounced : {false, true}) {
      RepairProposal proposal = propose_repair(scene.surface, some, *scene.restricted, crossing, bounced);
      proposal.facing.push_back(proposal.snapped);
      for (const ClosestPoint& place : proposal.facing) {
        EXPECT_LT(scene.surface.distance(place.position), 1e-9);
        const auto [a, b, c] = scene.surface.corners(place.triangle);
        EXPECT_LT(closest_point_of_triangle(place.position, a, b, c).distance, 1e-9);
        EXPECT_NEAR(place.distance, (place.position - some.points[crossing.component.cell]).norm(), 1e-12);
      }
    }
  }
}

TEST(ValleyBottom, IsTheNearestPointOfTheCommonEdgeUnlessAVertexIsInReach) {
  const Surface surface(test::extruded(test::v_groove(0.4), 1));
  SurfaceSampling sampling;
  add_point(surface, sampling, {1.4, 1.2, 0.4});
  const Index across = surface.closest({1.6, 1.2, 0.4}).triangle;
  const auto edge = bottom_of_valley(surface, sampling, 0, across, 0.1);
  ASSERT_TRUE(edge.has_value());
  EXPECT_NEAR((edge->position - Point(1.5, 0.3, sampling.points[0].z())).norm(), 0, 1e-9);
  const auto vertex = bottom_of_valley(surface, sampling, 0, across, 10);
  ASSERT_TRUE(vertex.has_value());
  EXPECT_NEAR((vertex->position - Point(1.5, 0.3, 0)).norm(), 0, 1e-9);
}

TEST(ValleyBottom, IsNowhereBetweenSidesThatDoNotMeet) {
  const Surface surface(test::two_boxes(0.1));
  SurfaceSampling sampling;
  add_point(surface, sampling, surface.bounding_box().min());
  const Index across = surface.closest(surface.bounding_box().max()).triangle;
  EXPECT_FALSE(bottom_of_valley(surface, sampling, 0, across, 10).has_value());
}

TEST(Neck, IsACellThatWrapsAroundAWire) {
  // Three points along a rod: the middle one's cell is a ring, and so it shares no point with three others.
  Scene scene(test::box({0, 0, 0}, {10, 0.1, 0.1}));
  for (const Point& near : {Point(5, 0.05, 0), Point(1, 0.05, 0), Point(9, 0.04, 0), Point(0, 0, 0.1)}) {
    add_point(scene.surface, scene.sampling, near);
  }
  scene.prepare();
  ASSERT_FALSE(scene.crossings.empty());
  EXPECT_TRUE(scene.crossings[0].neck);
  EXPECT_EQ(scene.crossings[0].component.euler_characteristic, 0);
  const auto [position, triangle] = farthest_corner(*scene.restricted, scene.crossings[0].component, kNone);
  EXPECT_NEAR(std::abs(position.x() - 5), 2, 0.1) << "half-way to the next point";
  EXPECT_NEAR(position.z(), 0.1, 1e-9) << "on the far side of the rod";
}

}  // namespace
}  // namespace orchard::detail
