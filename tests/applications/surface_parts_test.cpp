// Parts of surfaces by the sheets and necks of their axes.
#include "orchard/medial/surface_parts.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "orchard/geometry/error.h"
#include "orchard/medial/build.h"
#include "support/shapes.h"

namespace orchard {
namespace {

MedialMesh axis_for_parts(const Surface& surface) {
  MedialBuildOptions options{.refine = RefineOptions{}, .check_promise = false};
  options.sampling.face_points = 1200;
  options.sampling.edge_points = 300;
  return medial_mesh(build_medial_axis(surface, options).axis);
}

// Two balls of radius 1 at a distance of 4, joined by a tube of radius `neck`.
TriangleMesh dumbbell(double neck) {
  std::vector<std::array<double, 2>> profile;
  const double bend = std::asin(neck);
  for (int i = 0; i <= 16; ++i) {
    const double turn = (3.14159265358979 - bend) * i / 16;
    profile.push_back({i == 0 ? 0 : std::sin(turn), -2 - std::cos(turn)});
  }
  for (int i = 16; i >= 0; --i) {
    const double turn = (3.14159265358979 - bend) * i / 16;
    profile.push_back({i == 0 ? 0 : std::sin(turn), 2 + std::cos(turn)});
  }
  return test::turned(profile, 32);
}

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    area += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm() / 2;
  return area;
}

// The labels cover the surface once.
void expect_cover(const SurfaceParts& parts, const Surface& surface) {
  ASSERT_EQ(parts.parts_of.size(), parts.mesh.triangles.size());
  double area = 0;
  Index triangles = 0;
  for (Index i = 0; i < parts.parts.size(); ++i) {
    const TriangleMesh mesh = part_mesh(parts, i);
    EXPECT_EQ(mesh.triangles.size(), parts.parts[i].triangles);
    EXPECT_NEAR(area_of(mesh), parts.parts[i].area, 1e-9 * surface.report().area);
    area += parts.parts[i].area;
    triangles += parts.parts[i].triangles;
    EXPECT_GE(parts.parts[i].patches, 1u);
    if (i > 0) {
      EXPECT_LE(parts.parts[i].area, parts.parts[i - 1].area);
    }
  }
  EXPECT_EQ(triangles, parts.mesh.triangles.size());
  EXPECT_NEAR(area, surface.report().area, 1e-9 * area);
}

TEST(SurfaceParts, OfADumbbellAreItsBallsCutAtTheMiddleOfItsNeck) {
  const Surface solid(dumbbell(0.4));
  const MedialMesh axis = axis_for_parts(solid);
  const SurfaceParts parts = surface_parts(solid, axis, {.kind = PartKind::necks, .samples = 4000});
  expect_cover(parts, solid);
  ASSERT_EQ(parts.parts.size(), 2u);
  ASSERT_EQ(parts.necks.size(), 1u);
  EXPECT_NEAR(parts.necks[0].radius, 0.4, 0.03);
  EXPECT_NEAR(parts.necks[0].significance, 0.6, 0.03);
  EXPECT_LT(std::abs(parts.necks[0].place.z()), 1.2);
  EXPECT_EQ(parts.parts[0].patches, 1u);
  Index upper = kNone;
  for (std::size_t t = 0; t < parts.parts_of.size(); ++t) {
    if (parts.mesh.vertices[parts.mesh.triangles[t][0]].z() > 2.5) upper = parts.parts_of[t];
  }
  for (std::size_t t = 0; t < parts.parts_of.size(); ++t) {
    const double z = parts.mesh.vertices[parts.mesh.triangles[t][0]].z();
    if (std::abs(z) > 1.4) {
      EXPECT_EQ(parts.parts_of[t] == upper, z > 0);
    }
  }
  EXPECT_EQ(surface_parts(solid, axis, {.kind = PartKind::necks, .neck = 0.7, .samples = 4000}).parts.size(), 1u);
}

TEST(SurfaceParts, OfABoxAreTheSheetsOfItsAxis) {
  const Surface solid(test::box(Point(0, 0, 0), Point(4, 3, 1)));
  const MedialMesh axis = axis_for_parts(solid);
  const SurfaceParts parts = surface_parts(solid, axis, {.kind = PartKind::sheets, .samples = 8000});
  expect_cover(parts, solid);
  EXPECT_EQ(parts.parts.size(), 13u);  // the middle rectangle, and a sheet into each edge
  EXPECT_EQ(parts.parts[0].patches, 2u);
  EXPECT_NEAR(parts.parts[0].area, 2 * 3 * 2, 0.6);
  EXPECT_NEAR(parts.parts[0].max_radius, 0.5, 1e-9);
  const SurfaceParts both = surface_parts(solid, axis, {.samples = 8000});
  EXPECT_EQ(both.parts.size(), 13u);  // it has no necks
}

TEST(SurfaceParts, OfABallIsOne) {
  const Surface solid(test::icosphere(3));
  const SurfaceParts parts = surface_parts(solid, axis_for_parts(solid), {.kind = PartKind::necks, .samples = 2000});
  expect_cover(parts, solid);
  EXPECT_EQ(parts.parts.size(), 1u);
  EXPECT_TRUE(parts.necks.empty());
}

TEST(SurfaceParts, AreTheSameForEveryScaleAndNumberOfThreads) {
  const Surface solid(test::u_shape(0.5));
  MedialMesh axis = axis_for_parts(solid);
  const SurfaceParts parts = surface_parts(solid, axis, {.samples = 3000});
  expect_cover(parts, solid);
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const SurfaceParts again = surface_parts(solid, axis, {.samples = 3000});
    EXPECT_EQ(again.parts_of, parts.parts_of);
    EXPECT_EQ(again.radii, parts.radii);
  }
  for (Point& center : axis.centers) center *= 2;
  for (double& radius : axis.radii) radius *= 2;
  const Surface larger(test::transformed(test::u_shape(0.5), 2, Vector::Zero()));
  EXPECT_EQ(surface_parts(larger, axis, {.samples = 3000}).parts_of, parts.parts_of);
}

TEST(SurfaceParts, HaveNoPatchBelowTheSmallestArea) {
  const Surface solid(test::l_shape());
  const MedialMesh axis = axis_for_parts(solid);
  const SurfaceParts parts = surface_parts(solid, axis, {.kind = PartKind::sheets, .min_area = 0.05, .samples = 4000});
  expect_cover(parts, solid);
  for (const SurfaceParts::Part& part : parts.parts) EXPECT_GE(part.area, 0.05 * solid.report().area * part.patches);
  EXPECT_LT(parts.parts.size(), surface_parts(solid, axis, {.kind = PartKind::sheets, .samples = 4000}).parts.size());
}

TEST(SurfaceParts, RefuseOptionsOutOfRangeAndOpenSurfaces) {
  const Surface solid(test::box(Point(0, 0, 0), Point(1, 1, 1)));
  const MedialMesh axis{{Point(0.5, 0.5, 0.5)}, {0.5}, {}, {}};
  EXPECT_THROW(surface_parts(solid, axis, {.neck = -0.1}), InputError);
  EXPECT_THROW(surface_parts(solid, axis, {.neck = 1.1}), InputError);
  EXPECT_THROW(surface_parts(solid, axis, {.min_area = -1}), InputError);
  EXPECT_THROW(surface_parts(solid, axis, {.samples = 0}), InputError);
  EXPECT_THROW(surface_parts(solid, axis, {.smoothing = -1}), InputError);
  EXPECT_THROW(surface_parts(solid, axis, {.edge_length = 0}), InputError);
  EXPECT_THROW(surface_parts(Surface(test::open_box()), axis), InputError);
}

}  // namespace
}  // namespace orchard
