// As a program of its own sees it: in no namespace of orchard's, without any using.
#include "orchard/runtime/pose.h"

#include <gtest/gtest.h>

#include "orchard/runtime/motion.h"

namespace user {
namespace {

using Vec3 = orchard::runtime::Vec3;

TEST(Vec3, HasOperatorsThatProgramsOutsideItsNamespaceFind) {
  const orchard::runtime::Motion a{.position = {1, 2, 3}, .velocity = {1, 0, 0}}, b{.position = {4, 6, 8}};
  const auto apart = b.position - a.position;
  EXPECT_EQ(apart, Vec3(3, 4, 5));
  EXPECT_EQ(dot(apart, a.velocity), 3);
  EXPECT_EQ(a.position + 2 * a.velocity, Vec3(3, 2, 3));
}

TEST(Vec3, MixesWithTheArraysOfPosesAndContacts) {
  orchard::runtime::Pose pose;
  const Vec3 step = {1, 2, 3};
  pose.translation = step;
  const Vec3 moved = transform(pose, step);
  EXPECT_EQ(moved, Vec3(2, 4, 6));
  EXPECT_EQ(pose.translation - moved, Vec3(-1, -2, -3));
  EXPECT_EQ(Vec3{}, Vec3(0, 0, 0));
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && std::is_trivially_copyable_v<Vec3>);
}

}  // namespace
}  // namespace user
