#include "orchard/spheretree/outside_volume.h"

#include <gtest/gtest.h>

#include <numbers>

#include "orchard/geometry/error.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

using std::numbers::pi;

TEST(OutsideVolume, IsABallsVolumeLessTheSolidInIt) {
  for (const Vector& offset : {Vector(0, 0, 0), Vector(30, -4, 5)}) {
    const Surface surface(transformed(box(Point(0, 0, 0), Point(1, 2, 3)), 1, offset));
    const Sphere around{Point(0.5, 1, 1.5) + offset, 2};
    const std::vector<Sphere> balls{around, {around.center, 1.9}};  // the second adds nothing
    EXPECT_NEAR(outside_volume(surface, balls), ball_volume(2) - 6, 0.003 * (ball_volume(2) - 6));
  }
}

TEST(OutsideVolume, CountsWhatBallsShareOnce) {
  const Surface surface(box(Point(0, 0, 0), Point(1, 1, 1)));
  const std::vector<Sphere> apart{{Point(10, 0, 0), 1}, {Point(10, 0, 5), 1}};
  EXPECT_NEAR(outside_volume(surface, apart), 2 * ball_volume(1), 0.006 * ball_volume(1));
  // A distance of one radius between the centres: the lens is 5/12 of pi.
  const std::vector<Sphere> lens{{Point(10, 0, 0), 1}, {Point(10, 0, 1), 1}};
  const double both = 2 * ball_volume(1) - 5 * pi / 12;
  EXPECT_NEAR(outside_volume(surface, lens), both, 0.003 * both);
}

TEST(OutsideVolume, IsNothingForBallsInsideOrNone) {
  const Surface surface(l_shape());
  const double R = surface.bounding_radius();
  EXPECT_EQ(outside_volume(surface, std::vector<Sphere>{}), 0);
  Point inside = Point::Zero();
  double depth = 0;
  Random random(1, 1);
  for (int i = 0; i < 1000; ++i) {
    Point p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = random.uniform(surface.bounding_box().min()[axis], surface.bounding_box().max()[axis]);
    if (-surface.signed_distance(p) > depth) depth = -surface.signed_distance(p), inside = p;
  }
  ASSERT_GT(depth, 0.01 * R);
  EXPECT_LE(outside_volume(surface, std::vector<Sphere>{{inside, 0.99 * depth}}), 1e-12 * R * R * R);
  EXPECT_THROW(outside_volume(Surface(open_box()), std::vector<Sphere>{{inside, depth}}), InputError);
}

}  // namespace
}  // namespace orchard
