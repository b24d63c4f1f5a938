// Whether the strict definition of 6.2.4 can be satisfied by the points that 6.2.4 adds: it cannot, in general.
//
// Let two clusters A and B meet in an edge E at an angle t < 90 degrees, and m be a place of E whose nearest point p of
// the sampling lies on A but not on B. Then m is inside p's cell, so the cell reaches B, of which it holds a part with
// a border: there a face of p's cell crosses B, which does not contain p. So as long as no point of the sampling that
// is nearest to m lies on E, the definition is not met. What is added for it is p's normal projection onto B. It falls
// within B, since t is acute, at |p - m| cos t from m if p lies straight above m, and again not on E; then it is the
// nearest one to m, and everything is as before with A and B exchanged and a distance cos t times as long. This goes
// on for ever, in exact arithmetic; in doubles until points count as coincident, and then faces still cross.
#include <gtest/gtest.h>

#include <cmath>

#include "gaps/crossings.h"
#include "orchard/medial/gap_crossing.h"
#include "orchard/voronoi/exact.h"
#include "outlines.h"

namespace orchard::detail {
namespace {

constexpr double kDegrees = 40;  // between the two long sides, at the edge through the origin along z
const Point kMiddle(0, 0, 0.5);  // of that edge

TriangleMesh wedge() {
  const double across = std::tan(kDegrees / 2 * 3.14159265358979323846 / 180);
  return test::extruded({{0, 0}, {1, -across}, {1, across}}, 1);
}

void add_at(const Surface& surface, SurfaceSampling& sampling, const ClosestPoint& place) {
  for (const Point& point : sampling.points)
    if ((point - place.position).norm() < 1e-9 * surface.bounding_radius()) return;
  sampling.points.push_back(place.position);
  sampling.triangles.push_back(place.triangle);
  sampling.features.push_back(place.feature);
  sampling.origins.push_back(PointOrigin::repair);
}

std::vector<Crossing> crossings_of(const Surface& surface, const SurfaceSampling& sampling, GapDefinition definition) {
  const VoronoiDiagram diagram = exact_voronoi(sampling.points).diagram;
  const CellNeighbors neighbors(diagram);
  const RestrictedVoronoi restricted(surface, diagram.points, neighbors);
  return find_crossings(surface, sampling, restricted, ComponentScope::everything(surface, sampling),
                        {.definition = definition, .mend_necks = false});
}

// A pass as written: the cell's point projected onto the cluster that the cell crosses; where that falls outside of the
// cluster, snapped to each of the triangles that were crossed.
void add_as_written(const Surface& surface, SurfaceSampling& sampling, const std::vector<Crossing>& crossings) {
  for (const Crossing& crossing : crossings) {
    const Point point = sampling.points[crossing.component.cell];
    const Index first = crossing.component.triangles.front();
    const Vector& normal = surface.normal(first);
    const Point projected = point - normal.dot(point - surface.corners(first)[0]) * normal;
    ClosestPoint place;
    for (const Index triangle : surface.clusters().triangles[surface.clusters().of_triangle[first]]) {
      const auto [a, b, c] = surface.corners(triangle);
      ClosestPoint here = closest_point_of_triangle(projected, a, b, c);
      here.triangle = triangle;
      if (place.triangle == kNone || here.distance < place.distance) place = here;
    }
    if (place.distance < 1e-12) {
      add_at(surface, sampling, place);
      continue;
    }
    for (const Index triangle : crossing.component.triangles) {
      const auto [a, b, c] = surface.corners(triangle);
      ClosestPoint snapped = closest_point_of_triangle(projected, a, b, c);
      snapped.triangle = triangle;
      add_at(surface, sampling, snapped);
    }
  }
}

double nearest_to_middle(const SurfaceSampling& sampling) {
  double nearest = 10;
  for (const Point& point : sampling.points) nearest = std::min(nearest, (point - kMiddle).norm());
  return nearest;
}

TEST(StrictDefinition, IsNeverMetAtAnAcuteEdgeByTheProjectionsOfTheText) {
  const Surface surface(wedge());
  SurfaceSampling sampling;
  for (Index vertex = 0; vertex < surface.mesh().vertices.size(); ++vertex)
    add_at(surface, sampling, surface.closest(surface.mesh().vertices[vertex]));
  add_at(surface, sampling, surface.closest({0.3, 0.3 * std::tan(kDegrees / 2 / 57.29577951308232), 0.5}));
  double expected = nearest_to_middle(sampling);
  ASSERT_LT(expected, 0.5) << "nearer than the edge's own points";
  const double shrink = std::cos(kDegrees / 57.29577951308232);
  for (int pass = 0; pass < 8; ++pass) {
    const std::vector<Crossing> crossings = crossings_of(surface, sampling, GapDefinition::strict);
    ASSERT_FALSE(crossings.empty()) << "pass " << pass;
    add_as_written(surface, sampling, crossings);
    expected *= shrink;
    EXPECT_NEAR(nearest_to_middle(sampling), expected, 1e-9) << "pass " << pass;
  }
  EXPECT_FALSE(crossings_of(surface, sampling, GapDefinition::strict).empty());
  EXPECT_TRUE(crossings_of(surface, sampling, GapDefinition::loose).empty()) << "all sides of a wedge adjoin";
}

}  // namespace
}  // namespace orchard::detail
