#include "orchard/geometry/outside_solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

TEST(OutsideSolid, IsWhatTheSolidIsNot) {
  for (const TriangleMesh& mesh : {test::box({0, 0, 0}, {1, 2, 3}), test::torus(24, 12), test::two_boxes(0.5),
                                   test::l_shape(), test::icosphere(2)}) {
    const Surface solid(mesh);
    const Surface outside(outside_solid(solid, 1.5));
    ASSERT_TRUE(outside.solid());
    const Sphere& ball = solid.bounding_ball();
    Random random(test::first_seed() + 3, 5);
    for (std::uint64_t i = 0; i < 300 * test::more(); ++i) {
      const Vector offset(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Point place = ball.center + 1.4 * ball.radius * offset;
      if ((place - ball.center).norm() > 1.45 * ball.radius) continue;  // beyond the facets of the sphere
      EXPECT_NE(solid.inside(place), outside.inside(place)) << place.transpose();
    }
    EXPECT_FALSE(outside.inside(ball.center + 1.6 * ball.radius * Vector::UnitX()));
  }
}

TEST(OutsideSolid, KeepsTheTrianglesAndPutsTheSphereAfterThem) {
  const TriangleMesh box = test::box({0, 0, 0}, {1, 2, 3});
  const Surface solid(box);
  const TriangleMesh mesh = outside_solid(solid);
  ASSERT_EQ(mesh.triangles.size(), box.triangles.size() + 1280);
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    EXPECT_EQ(mesh.triangles[t][0], box.triangles[t][0]);
    EXPECT_EQ(mesh.triangles[t][1], box.triangles[t][2]);
    EXPECT_EQ(mesh.triangles[t][2], box.triangles[t][1]);
  }
  for (std::size_t v = box.vertices.size(); v < mesh.vertices.size(); ++v)
    EXPECT_NEAR((mesh.vertices[v] - solid.bounding_ball().center).norm(), 2 * solid.bounding_radius(), 1e-12);
}

TEST(OutsideSolid, HasThePointsOfTheSolidAndTheSpheresVertices) {
  const Surface solid(test::box({0, 0, 0}, {1, 2, 3}));
  const Surface outside(outside_solid(solid));
  const SamplingOptions options{.face_points = 80, .edge_points = 20};
  const SurfaceSampling inner = sample_surface(solid, options), all = sample_outside(solid, outside, options);
  ASSERT_EQ(all.size(), inner.size() + 642);
  for (Index i = 0; i < inner.size(); ++i) {
    EXPECT_EQ(all.points[i], inner.points[i]);
    EXPECT_LT(all.triangles[i], solid.mesh().triangles.size());
  }
  EXPECT_NO_THROW(validate(all, outside));
}

TEST(OutsideSolid, IsRefusedWhereThereIsNoneAndForSpheresThatAreTooSmall) {
  EXPECT_THROW(outside_solid(Surface(test::open_box())), InputError);
  const Surface solid(test::icosphere(1));
  for (const double radius : {1.0, 0.0, -2.0, std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_THROW(outside_solid(solid, radius), InputError) << radius;
}

}  // namespace
}  // namespace orchard
