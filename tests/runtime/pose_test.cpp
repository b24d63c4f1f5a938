#include "orchard/runtime/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

void expect_near(const Vec& a, const Vec& b, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance);
}

TEST(Pose, FromAQuaternionTurnsCounterclockwiseAboutItsAxis) {
  const double s = std::sqrt(0.5);
  expect_near(transform(*pose_from_quaternion({s, 0, 0, s}, {10, 20, 30}), {1, 0, 0}), {10, 21, 30}, 1e-15);
  expect_near(transform(*pose_from_quaternion({s, s, 0, 0}, {0, 0, 0}), {0, 1, 0}), {0, 0, 1}, 1e-15);
  expect_near(transform(*pose_from_quaternion({s, 0, s, 0}, {0, 0, 0}), {0, 0, 1}), {1, 0, 0}, 1e-15);
  EXPECT_EQ(*pose_from_quaternion({-3, 0, 0, 0}, {0, 0, 0}), Pose{});
}

TEST(Pose, FromAQuaternionOfAnyLengthIsRigid) {
  const double lengths[] = {1, 1e-3, 1e150, 1e-150, 1e300, 4e-324};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draw draw(seed);
    std::array<double, 4> q{};
    for (double& x : q) x = draw.uniform(-1, 1);
    for (const double length : lengths) {
      std::array<double, 4> scaled = q;
      for (double& x : scaled) x *= length;
      if (scaled == std::array<double, 4>{}) continue;  // rounded to nothing
      const auto pose = pose_from_quaternion(scaled, {1, 2, 3});
      ASSERT_TRUE(pose && is_rigid(*pose)) << seed << " " << length;
    }
  }
}

TEST(Pose, IsRefusedForQuaternionsThatNameNoRotation) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(pose_from_quaternion({0, 0, -0.0, 0}, {0, 0, 0}));
  EXPECT_FALSE(pose_from_quaternion({1, nan, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(pose_from_quaternion({infinity, 0, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(pose_from_quaternion({1, 0, 0, 0}, {0, nan, 0}));
  EXPECT_FALSE(pose_from_quaternion({1, 0, 0, 0}, {0, 0, -infinity}));
}

TEST(Pose, ComposesAndInverts) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draw draw(seed);
    const Pose outer = draw.pose(3), inner = draw.pose(2);
    const Vec point = draw.direction();
    expect_near(transform(compose(outer, inner), point), transform(outer, transform(inner, point)), 1e-14);
    expect_near(transform(inverse(outer), transform(outer, point)), point, 1e-14);
    EXPECT_TRUE(is_rigid(compose(outer, inverse(inner))));
    expect_near(rotate(outer, point), rotate(compose(outer, Pose{}), point), 0);
  }
  EXPECT_EQ(inverse(Pose{}), Pose{});
  EXPECT_FALSE(std::signbit(inverse(Pose{}).translation[0]));
}

TEST(Pose, IsRigidOnlyForProperRotations) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_rigid(Pose{}));
  EXPECT_TRUE(is_rigid({{0, -1, 0, 1, 0, 0, 0, 0, 1}, {1e300, 0, 0}}));
  EXPECT_FALSE(is_rigid({{-1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}})) << "mirrored";
  EXPECT_FALSE(is_rigid({{2, 0, 0, 0, 2, 0, 0, 0, 2}, {0, 0, 0}})) << "scaled";
  EXPECT_FALSE(is_rigid({{1, 1e-6, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}})) << "sheared";
  EXPECT_FALSE(is_rigid({{1, 0, 0, 0, 1, 0, 0, 0, nan}, {0, 0, 0}}));
  EXPECT_FALSE(is_rigid({{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, nan, 0}}));
}

}  // namespace
}  // namespace orchard::runtime
