#include "orchard/geometry/unite.h"

#include <gtest/gtest.h>

#include <cmath>

#include "orchard/geometry/error.h"
#include "orchard/geometry/surface.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using namespace test;

double volume_of(const TriangleMesh& mesh) { return Surface(mesh).report().volume; }

TEST(UniteParts, MakesOneSolidOfPartsThatCutEachOther) {
  // A cross of two bars, and a third box that only touches nothing.
  const TriangleMesh cross = joined({box(Point(-3, -1, -1), Point(3, 1, 1)), box(Point(-1, -3, -0.5), Point(1, 3, 0.5)),
                                     box(Point(10, 0, 0), Point(11, 1, 1))});
  const auto united = unite_parts(cross);
  ASSERT_TRUE(united);
  const Surface surface(united->mesh);
  EXPECT_TRUE(surface.solid());
  EXPECT_EQ(surface.report().components, 2);
  EXPECT_EQ(united->parts, 2u);
  EXPECT_GT(united->cut_before, 0u);
  EXPECT_EQ(united->cut_left, 0u);
  EXPECT_NEAR(volume_of(united->mesh), 6 * 2 * 2 + 2 * 4 * 1 * 1 + 1, 1e-12);
}

TEST(UniteParts, UnitesRoundPartsToTheSumOfTheirVolumes) {
  // By inclusion and exclusion, with the common part of two equal balls about a distance apart that is known.
  const TriangleMesh balls = joined({icosphere(3), transformed(icosphere(3), 1, Vector(0.7, 0.1, 0.2))});
  const auto united = unite_parts(balls);
  ASSERT_TRUE(united);
  const double one = volume_of(icosphere(3)), both = volume_of(united->mesh);
  EXPECT_TRUE(Surface(united->mesh).solid());
  EXPECT_GT(both, one);
  EXPECT_LT(both, 2 * one);
  const double d = Vector(0.7, 0.1, 0.2).norm(), lens = std::acos(-1) * (4 + d) * (2 - d) * (2 - d) / 12;
  EXPECT_NEAR(both, 2 * one - lens, 0.02 * one);
  EXPECT_EQ(united->cut_left, 0u);
}

TEST(UniteParts, LeavesPartsThatDoNotCutEachOther) {
  EXPECT_FALSE(unite_parts(two_boxes(0.5)));
  EXPECT_FALSE(unite_parts(box(Point(0, 0, 0), Point(1, 1, 1))));
}

TEST(UniteParts, GivesUpWhereAPartCutsItself) {
  TriangleMesh crossed = u_shape(0.5);  // its left arm goes through its right arm
  for (Point& p : crossed.vertices)
    if (p.y() > 1.5 && p.x() < 1.5) p.x() += 2.5;
  ASSERT_TRUE(Surface(crossed).solid());
  ASSERT_FALSE(Surface(crossed).self_intersections().empty());
  EXPECT_FALSE(unite_parts(crossed));
}

TEST(UniteParts, RefusesWhatIsNoSolid) { EXPECT_THROW(unite_parts(open_box()), InputError); }

TEST(UniteParts, GivesTheSameBytesWhenAskedAgain) {
  const TriangleMesh balls = joined({icosphere(2), transformed(icosphere(2), 1, Vector(0.3, 0.4, 0.5))});
  EXPECT_EQ(unite_parts(balls)->mesh.vertices, unite_parts(balls)->mesh.vertices);
  EXPECT_EQ(unite_parts(balls)->mesh.triangles, unite_parts(balls)->mesh.triangles);
}

}  // namespace
}  // namespace orchard
