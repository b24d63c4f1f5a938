#include "orchard/medial/import_axis.h"

#include <gtest/gtest.h>

#include <numeric>

#include "orchard/geometry/error.h"
#include "orchard/medial/build.h"
#include "orchard/medial/topology.h"
#include "support/shapes.h"

namespace orchard {
namespace {

SurfaceSampling samples_of(const Surface& surface, Index points = 600) {
  return sample_surface(surface, {.face_points = points, .edge_points = points / 4});
}

MedialMesh mesh_of_axis(const Surface& surface) {
  return medial_mesh(build_medial_axis(surface, {.sampling = {.face_points = 800, .edge_points = 200}}).axis);
}

TEST(ImportAxis, OfOrchardsOwnAxisKeepsEveryBallAndTheTopology) {
  for (const TriangleMesh& mesh : {test::l_shape(), test::torus(24, 12), test::u_shape(0.2)}) {
    const Surface surface(mesh);
    const MedialMesh own = mesh_of_axis(surface);
    const ImportedAxis imported = import_axis(surface, own, samples_of(surface));
    EXPECT_EQ(imported.refused, 0u);
    EXPECT_EQ(imported.axis.centers, own.centers);
    EXPECT_EQ(topology(medial_mesh(imported.axis)), topology(own));
    for (Index v = 0; v < own.size(); ++v)
      EXPECT_NEAR(imported.axis.radii[v], surface.distance(own.centers[v]), 1e-12 * surface.bounding_radius());
  }
}

TEST(ImportAxis, GivesEveryBallItsNearestPointAndEverySampleOneBall) {
  const Surface surface(test::u_shape(0.2));
  const SurfaceSampling sampling = samples_of(surface);
  const ImportedAxis imported = import_axis(surface, mesh_of_axis(surface), sampling);
  const MedialAxis& axis = imported.axis;
  ASSERT_NO_THROW(validate(imported.sampling, surface));
  ASSERT_EQ(axis.points.size(), sampling.points.size() + axis.size());
  std::vector<Index> balls(axis.points.size(), 0);
  for (Index v = 0; v < axis.size(); ++v) {
    const Index own = sampling.size() + v;
    EXPECT_NEAR((axis.points[own] - axis.centers[v]).norm(), axis.radii[v], 1e-12);
    EXPECT_EQ(axis.forming_points[v].back(), own);
    for (const Index p : axis.forming_points[v]) ++balls[p];
  }
  EXPECT_EQ(balls, std::vector<Index>(axis.points.size(), 1));
  for (Index p = 0; p < sampling.size(); ++p) {  // by brute force: no other ball comes nearer
    double min = 1e9, own = 1e9;
    for (Index v = 0; v < axis.size(); ++v) {
      const double gap = (axis.points[p] - axis.centers[v]).norm() - axis.radii[v];
      min = std::min(min, gap);
      const auto row = axis.forming_points[v];
      if (std::binary_search(row.begin(), row.end(), p)) own = gap;
    }
    EXPECT_EQ(own, min);
  }
}

TEST(ImportAxis, RefusesBallsOutsideWithTheirCellsAndCorrectsRadii) {
  const Surface surface(test::box(Point(0, 0, 0), Point(4, 4, 2)));
  MedialMesh mesh;
  mesh.centers = {Point(1, 1, 1), Point(3, 1, 1), Point(2, 3, 1), Point(9, 9, 9), Point(4, 2, 1)};
  mesh.radii = {1, 1, 0.4, 1, 0};  // the third is too small, the fourth outside, the last one on the surface
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  complete(mesh);
  const ImportedAxis imported = import_axis(surface, mesh, samples_of(surface));
  EXPECT_EQ(imported.refused, 2u);
  EXPECT_EQ(imported.adjusted, 1u);
  EXPECT_NEAR(imported.adjustment, 0.6, 1e-12);
  EXPECT_EQ(imported.axis.size(), 3u);
  EXPECT_EQ(imported.axis.faces.size(), 1u);
  EXPECT_EQ(imported.axis.neighbors.items.size(), 6u);
  EXPECT_EQ(imported.axis.radii, (std::vector<double>{1, 1, 1}));
}

TEST(ImportAxis, ReportsItsProgressAHundredTimesAtMostHoweverManySamples) {
  const Surface surface(test::l_shape());
  const MedialMesh own = mesh_of_axis(surface);
  int reports = 0;
  double last = -1;
  import_axis(surface, own, samples_of(surface, 4000), [&](std::string_view, double fraction) {
    EXPECT_GT(fraction, last);
    last = fraction;
    return ++reports > 0;
  });
  EXPECT_LE(reports, 100);
  EXPECT_GT(reports, 10);
  EXPECT_EQ(last, 1);
}

TEST(ImportAxis, NeedsASolidAndABallInIt) {
  const Surface surface(test::box(Point(0, 0, 0), Point(1, 1, 1)));
  MedialMesh mesh;
  mesh.centers = {Point(9, 9, 9)};
  mesh.radii = {1};
  EXPECT_THROW(import_axis(surface, mesh, samples_of(surface)), InputError);
  const Surface open(test::open_box());
  EXPECT_THROW(import_axis(open, mesh, samples_of(open)), InputError);
}

}  // namespace
}  // namespace orchard
