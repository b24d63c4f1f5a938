#include "orchard/geometry/clip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "orchard/geometry/error.h"
#include "orchard/geometry/surface.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using namespace test;

TEST(ClipSolid, LeavesThePartWithItsCap) {
  const Surface part(clip_solid(box(Point(0, 0, 0), Point(2, 3, 4)), {Vector(0, 0, 2), 2}));  // z >= 1
  EXPECT_TRUE(part.solid());
  EXPECT_NEAR(part.report().volume, 2 * 3 * 3, 1e-12);
  EXPECT_NEAR(part.report().area, 2 * (2 * 3 + 3 * 3 + 2 * 3), 1e-12);
  EXPECT_NEAR(part.bounding_box().min().z(), 1, 1e-15);
}

TEST(ClipSolid, TakesAnyDirection) {
  // The corner of a cube, beyond the plane through the three corners next to it.
  const Surface part(clip_solid(box(Point(0, 0, 0), Point(1, 1, 1)), {Vector(-1, -1, -1), -1}));
  EXPECT_NEAR(part.report().volume, 1.0 / 6, 1e-12);
  const Surface cap(clip_solid(icosphere(4), {Vector::UnitX(), 0.5}));
  const double height = 0.5, whole = std::acos(-1) * height * height * (3 - height) / 3;
  EXPECT_NEAR(cap.report().volume, whole, 0.01 * whole);
}

TEST(ClipSolid, CutsAShapeIntoSeveralParts) {
  // The second plane is that of a face, and goes through corners.
  for (const double from : {1.25, 1.0}) {
    const Surface part(clip_solid(u_shape(0.5), {Vector::UnitY(), from}));
    EXPECT_TRUE(part.solid());
    EXPECT_NEAR(part.report().volume, 2 * 1.25 * (2 - from), 1e-12);
    EXPECT_GE(part.bounding_box().min().y(), from - 1e-15);
  }
}

TEST(ClipSolid, LeavesAWholeSolidAsItIs) {
  const TriangleMesh mesh = box(Point(0, 0, 0), Point(1, 1, 1));
  EXPECT_EQ(clip_solid(mesh, {Vector::UnitX(), -5}).vertices, mesh.vertices);
}

TEST(ClipSolid, RefusesWhatLeavesNothingAndWhatIsNoPlane) {
  const TriangleMesh mesh = box(Point(0, 0, 0), Point(1, 1, 1));
  EXPECT_THROW(clip_solid(mesh, {Vector::UnitX(), 2}), InputError);
  EXPECT_THROW(clip_solid(mesh, {Vector::Zero(), 0}), InputError);
  EXPECT_THROW(clip_solid(mesh, {Vector::UnitX(), std::nan("")}), InputError);
  EXPECT_THROW(clip_solid(open_box(), {Vector::UnitX(), 0}), InputError);
}

}  // namespace
}  // namespace orchard
