#include "orchard/runtime/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "improper_poses.h"

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

TEST(Pose, IsRigidForNothingElseThatAProgramMayHandOver) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Draw draw(seed);
    const Pose proper = draw.pose(3);
    ASSERT_TRUE(is_rigid(proper));
    for (const auto& [name, pose] : improper_poses(proper)) {
      ASSERT_FALSE(is_rigid(pose)) << name << " " << seed;
    }
  }
}

// The nearest rotation Q to a matrix X is the one for which Q^T X is symmetric and positive (Higham 1986).
void expect_nearest(const Pose& found, const Pose& matrix) {
  const auto &q = found.rotation, &x = matrix.rotation;
  const auto entry = [&](std::size_t i, std::size_t j) {
    return q[i] * x[j] + q[3 + i] * x[3 + j] + q[6 + i] * x[6 + j];
  };
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_GT(entry(i, i), 0.9);
    for (std::size_t j = 0; j < 3; ++j) ASSERT_NEAR(entry(i, j), entry(j, i), 4e-15);
  }
  ASSERT_TRUE(is_rigid(found));
  ASSERT_EQ(found.translation, matrix.translation);
  ASSERT_EQ(found.scale, matrix.scale);
}

TEST(Pose, OfFloatsIsMadeRigidByTheNearestRotation) {
  int not_rigid = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Pose truth = draw.pose(3), given = rounded_to_float(truth);
    not_rigid += !is_rigid(given);
    std::array<float, 9> rotation{};
    std::array<float, 3> translation{};
    for (std::size_t i = 0; i < 9; ++i) rotation[i] = static_cast<float>(truth.rotation[i]);
    for (std::size_t i = 0; i < 3; ++i) translation[i] = static_cast<float>(truth.translation[i]);
    const auto pose = pose_from_matrix(rotation, translation, 2.5f), again = made_rigid(given);
    ASSERT_TRUE(pose && again);
    ASSERT_EQ(pose->rotation, again->rotation);
    Pose scaled = given;
    scaled.scale = 2.5;
    expect_nearest(*pose, scaled);
    for (std::size_t i = 0; i < 9; ++i) ASSERT_NEAR(pose->rotation[i], truth.rotation[i], 1.2e-7);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(not_rigid, 990);
}

TEST(Pose, IsMadeRigidUpToAThousandthAndNoFarther) {
  int made = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Draw draw(seed);
    Pose pose = draw.pose(3);
    const double size = std::pow(10, draw.uniform(-14, 0));
    for (double& x : pose.rotation) x += draw.uniform(-size, size);
    const auto found = made_rigid(pose);
    (found ? made : refused) += 1;
    ASSERT_TRUE(found || size > 2e-4) << seed;
    ASSERT_TRUE(!found || size < 1e-2) << seed;
    if (found) expect_nearest(*found, pose);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(made, 600);
  EXPECT_GT(refused, 100);
  const Pose proper = Draw(1).pose(3);
  for (const auto& [name, pose] : improper_poses(proper)) {
    const bool only_rounded = name == "floats" || name == "a little shear" || name == "a scaled matrix";
    ASSERT_EQ(made_rigid(pose).has_value(), only_rounded) << name;
  }
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
