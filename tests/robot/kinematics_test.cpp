#include "robot/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "orchard/geometry/error.h"
#include "robot/urdf_values.h"

namespace orchard::robot {
namespace {

// A turn about z, a slide along the turned x that follows the turn, and a turn about a slanted axis.
Robot chain() {
  Robot robot;
  for (const char* name : {"a", "b", "c", "d"}) {
    robot.links.emplace_back();
    robot.links.back().name = name;
  }
  const auto add = [&](const char* name, JointKind kind, Index parent, const Vector& axis) -> Joint& {
    Joint& joint = robot.joints.emplace_back();
    joint.name = name;
    joint.kind = kind;
    joint.parent = parent;
    joint.child = parent + 1;
    joint.axis = axis;
    joint.origin = motion_of(Vector(1, 2, 3), Vector(0.1, 0.2, 0.3));
    joint.limits = JointLimits{.lower = -1, .upper = 0.5};
    return joint;
  };
  add("turn", JointKind::revolute, 0, Vector::UnitZ());
  add("slide", JointKind::prismatic, 1, Vector::UnitX()).mimic = Mimic{.joint = 0, .multiplier = -2, .offset = 0.25};
  add("bend", JointKind::continuous, 2, Vector(1, 1, 0).normalized());
  return robot;
}

// Rz Ry Rx, term by term.
Eigen::Matrix4d matrix(double x, double y, double z, double roll, double pitch, double yaw) {
  const double cr = std::cos(roll), sr = std::sin(roll), cp = std::cos(pitch), sp = std::sin(pitch), cy = std::cos(yaw),
               sy = std::sin(yaw);
  Eigen::Matrix4d m;
  m << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, x, sy * cp, sy * sp * sr + cy * cr,
      sy * sp * cr - cy * sr, y, -sp, cp * sr, cp * cr, z, 0, 0, 0, 1;
  return m;
}

TEST(Kinematics, PlacesLinksAsProductsOfMatrices) {
  const Robot robot = chain();
  const JointValues values = joint_values(robot, std::map<std::string, double>{{"turn", 0.4}, {"bend", 0}});
  ASSERT_EQ(values.size(), 3);
  EXPECT_DOUBLE_EQ(values[1], -2 * 0.4 + 0.25);
  const Eigen::Matrix4d step = matrix(1, 2, 3, 0.1, 0.2, 0.3);
  const Eigen::Matrix4d b = step * matrix(0, 0, 0, 0, 0, 0.4), c = b * step * matrix(values[1], 0, 0, 0, 0, 0);
  const std::vector<Motion> motions = link_motions(robot, values);
  EXPECT_LT((motions[0].matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-15);
  EXPECT_LT((motions[1].matrix() - b).norm(), 1e-14);
  EXPECT_LT((motions[2].matrix() - c).norm(), 1e-14);
  EXPECT_LT((motions[3].matrix() - c * step).norm(), 1e-14);
}

TEST(Kinematics, TurnsAboutAnyAxisLeaveTheAxis) {
  const Robot robot = chain();
  const auto at = [&](double bend) {
    return link_motions(robot, joint_values(robot, std::map<std::string, double>{{"bend", bend}}))[3];
  };
  const Vector axis = Vector(1, 1, 0).normalized();
  EXPECT_LT((at(0) * axis - at(2.5) * axis).norm(), 1e-14);
  EXPECT_GT((at(0) * Vector::UnitZ() - at(2.5) * Vector::UnitZ()).norm(), 1);
}

TEST(Kinematics, RandomStatesStayWithinLimitsAndDependOnTheSeedAlone) {
  const Robot robot = chain();
  double least = 1, most = -1;
  for (std::uint64_t item = 0; item < 500; ++item) {
    Random random(7, 1, item), same(7, 1, item);
    const JointValues values = random_joint_values(robot, random);
    EXPECT_EQ(values, random_joint_values(robot, same));
    EXPECT_DOUBLE_EQ(values[1], -2 * values[0] + 0.25);
    least = std::min(least, values[0]);
    most = std::max(most, values[0]);
  }
  EXPECT_GE(least, -1);
  EXPECT_LT(least, -0.95);
  EXPECT_LE(most, 0.5);
  EXPECT_GT(most, 0.45);
}

TEST(Kinematics, RefuseJointsThatDoNotMoveByThemselves) {
  EXPECT_THROW(joint_values(chain(), std::map<std::string, double>{{"slide", 0}}), InputError);
  EXPECT_THROW(joint_values(chain(), std::map<std::string, double>{{"none", 0}}), InputError);
}

}  // namespace
}  // namespace orchard::robot
