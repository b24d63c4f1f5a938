#include "orchard/medial/topology.h"

#include <gtest/gtest.h>

#include <utility>

#include "orchard/geometry/error.h"
#include "orchard/medial/gap_crossing.h"
#include "orchard/voronoi/exact.h"
#include "outlines.h"
#include "support/shapes.h"

namespace orchard {
namespace {

MedialMesh complex_of(Index vertices, std::vector<std::array<Index, 2>> edges,
                      std::vector<std::array<Index, 3>> triangles) {
  MedialMesh mesh;
  mesh.centers.assign(vertices, Point::Zero());
  mesh.radii.assign(vertices, 1.0);
  mesh.edges = std::move(edges);
  mesh.triangles = std::move(triangles);
  complete(mesh);
  validate(mesh);
  return mesh;
}

MedialMesh complex_of(const TriangleMesh& mesh) {
  return complex_of(static_cast<Index>(mesh.vertices.size()), {}, mesh.triangles);
}

Topology betti(std::int64_t components, std::int64_t loops, std::int64_t cavities) {
  return {.components = components, .loops = loops, .cavities = cavities};
}

TEST(ComplexTopology, OfGraphs) {
  EXPECT_EQ(topology(complex_of(1, {}, {})), betti(1, 0, 0));
  EXPECT_EQ(topology(complex_of(4, {{0, 1}, {1, 2}}, {})), betti(2, 0, 0));
  EXPECT_EQ(topology(complex_of(4, {{0, 1}, {1, 2}, {0, 2}, {2, 3}}, {})), betti(1, 1, 0));
}

TEST(ComplexTopology, OfSheets) {
  EXPECT_EQ(topology(complex_of(3, {}, {{0, 1, 2}})), betti(1, 0, 0));
  // A band around a hole.
  EXPECT_EQ(topology(complex_of(6, {}, {{0, 1, 3}, {1, 3, 4}, {1, 2, 4}, {2, 4, 5}, {0, 2, 5}, {0, 3, 5}})),
            betti(1, 1, 0));
}

TEST(ComplexTopology, OfClosedSheets) {
  EXPECT_EQ(topology(complex_of(test::icosphere(2))), betti(1, 0, 1));
  EXPECT_EQ(topology(complex_of(test::torus(12, 8))), betti(1, 2, 1));
  EXPECT_EQ(topology(complex_of(test::two_boxes(0.1))), betti(2, 0, 2));
  // Two tetrahedra with a wall between them, without it, and with a flag on it.
  const std::vector<std::array<Index, 3>> walls{{0, 1, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 4}, {0, 2, 4}, {1, 2, 4}};
  EXPECT_EQ(topology(complex_of(5, {}, walls)), betti(1, 0, 1));
  auto divided = walls;
  divided.push_back({0, 1, 2});
  EXPECT_EQ(topology(complex_of(5, {}, divided)), betti(1, 0, 2));
  divided.push_back({0, 1, 5});
  EXPECT_EQ(topology(complex_of(6, {}, divided)), betti(1, 0, 2));
}

TriangleMesh hollow_box() {
  TriangleMesh cavity = test::box({0.3, 0.3, 0.4}, {0.6, 0.6, 0.6});
  for (auto& corners : cavity.triangles) std::swap(corners[0], corners[1]);
  return test::joined({test::box({0, 0, 0}, {1, 1, 1}), cavity});
}

TEST(SolidTopology, CountsComponentsHandlesAndCavities) {
  EXPECT_EQ(solid_topology(Surface(test::box({0, 0, 0}, {1, 1, 1}))), betti(1, 0, 0));
  EXPECT_EQ(solid_topology(Surface(test::torus(16, 8))), betti(1, 1, 0));
  EXPECT_EQ(solid_topology(Surface(test::two_boxes(0.1))), betti(2, 0, 0));
  EXPECT_THROW(solid_topology(Surface(test::open_box())), InputError);
}

struct Axis {
  Topology found, wanted;
  Index size = 0, stems_and_bridges = 0, left_out = 0;
};

Axis axis_topology(TriangleMesh mesh, bool repair, bool keep) {
  const Surface surface(std::move(mesh));
  SurfaceSampling sampling = sample_surface(surface, {.face_points = 800, .edge_points = 200});
  VoronoiDiagram diagram = exact_voronoi(sampling.points).diagram;
  if (repair) {
    GapRepair repaired = repair_gap_crossings(surface, std::move(sampling), std::move(diagram));
    sampling = std::move(repaired.sampling);
    diagram = std::move(repaired.diagram);
  }
  const MedialAxis axis = medial_axis(surface, sampling, diagram, {.keep_topology = keep});
  validate(axis, surface);
  const MedialMesh result = medial_mesh(axis);
  validate(result);
  return {topology(result), solid_topology(surface), axis.size(), axis.stems + axis.bridges, axis.left_out};
}

TEST(AxisTopology, IsThatOfTheSolidAfterRepair) {
  for (const TriangleMesh& mesh : {test::box({0, 0, 0}, {1, 2, 3}), test::torus(32, 16), test::l_shape(),
                                   test::two_boxes(0.01), test::u_shape(0.02), test::extruded(test::knees(0.02), 1)}) {
    const Axis axis = axis_topology(mesh, true, true);
    EXPECT_EQ(axis.found, axis.wanted) << axis.found.loops << ' ' << axis.found.cavities;
    EXPECT_EQ(axis.stems_and_bridges + axis.left_out, 0u);
  }
}

TEST(AxisTopology, SurroundsACavity) {
  const Axis axis = axis_topology(hollow_box(), true, true);
  EXPECT_EQ(axis.wanted, betti(1, 0, 1));
  EXPECT_EQ(axis.found, axis.wanted);
}

TEST(AxisTopology, IsKeptWhereGapsWereNotMended) {
  for (const TriangleMesh& mesh : {test::extruded(test::thin_bridge(0.004), 1), test::two_boxes(0.01)}) {
    const Axis as_found = axis_topology(mesh, false, false);
    EXPECT_NE(as_found.found, as_found.wanted) << "the case shows no fault";
    const Axis kept = axis_topology(mesh, false, true);
    EXPECT_EQ(kept.found, kept.wanted);
    EXPECT_GT(kept.stems_and_bridges, 0u);
    EXPECT_EQ(kept.left_out, 0u);
    EXPECT_GE(kept.size, as_found.size);  // all of them: the sheets that spoil it are gone, the balls are not
  }
}

TEST(GapRepairAtCuts, AddsNoPointsWhereSheetsCross) {
  const Surface surface(
      test::joined({test::box({0, 0, 0}, {1, 1, 1}), test::box({0.53, 0.31, 0.27}, {1.61, 0.69, 0.73})}));
  ASSERT_TRUE(surface.solid());
  SurfaceSampling sampling = sample_surface(surface, {.face_points = 800, .edge_points = 200});
  VoronoiDiagram diagram = exact_voronoi(sampling.points).diagram;
  const GapRepair repaired = repair_gap_crossings(surface, sampling, std::move(diagram));
  EXPECT_GT(repaired.report.faces_at_cuts, 0u);
  EXPECT_EQ(repaired.report.faces_still_crossing, repaired.report.faces_at_cuts);
  EXPECT_LT(10 * repaired.report.points_added, sampling.size());
}

}  // namespace
}  // namespace orchard
