#include "robot/kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "orchard/geometry/error.h"

namespace orchard::robot {
namespace {

std::array<double, 2> range_of(const Joint& joint) {
  if (joint.kind == JointKind::continuous || !joint.limits) return {-std::numbers::pi, std::numbers::pi};
  return {joint.limits->lower, joint.limits->upper};
}

Motion motion_of(const Joint& joint, double value) {
  Motion motion = Motion::Identity();
  if (joint.kind == JointKind::revolute || joint.kind == JointKind::continuous)
    motion.linear() = Eigen::AngleAxisd(value, joint.axis).toRotationMatrix();
  if (joint.kind == JointKind::prismatic) motion.translation() = value * joint.axis;
  return joint.origin * motion;
}

double value_of(const Robot& robot, Index joint, const JointValues& free_values) {
  const Joint& own = robot.joints[joint];
  if (!own.mimic) return free_values[joint];
  return own.mimic->multiplier * value_of(robot, own.mimic->joint, free_values) + own.mimic->offset;
}

}  // namespace

JointValues joint_values(const Robot& robot, std::span<const double> free) {
  JointValues values(robot.joints.size(), 0);
  const std::vector<Index> joints = robot.free_joints();
  for (std::size_t i = 0; i < joints.size(); ++i) values[joints[i]] = free[i];
  const JointValues own = values;
  for (Index joint = 0; joint < values.size(); ++joint) values[joint] = value_of(robot, joint, own);
  return values;
}

JointValues joint_values(const Robot& robot, const std::map<std::string, double>& by_name) {
  std::vector<double> free;
  std::map<std::string, double> left = by_name;
  for (const Index index : robot.free_joints()) {
    const Joint& joint = robot.joints[index];
    const auto [lower, upper] = range_of(joint);
    const auto given = left.find(joint.name);
    free.push_back(given == left.end() ? std::clamp(0.0, lower, upper) : given->second);
    if (!std::isfinite(free.back())) throw InputError(fmt::format("joint {}: the value is not finite", joint.name));
    if (given != left.end()) left.erase(given);
  }
  if (left.empty()) return joint_values(robot, free);
  std::vector<std::string> names;
  for (const Index index : robot.free_joints()) names.push_back(robot.joints[index].name);
  throw InputError(fmt::format("{}: there is no free joint {}; the free joints are {}", robot.file.string(),
                               left.begin()->first, fmt::join(names, ", ")));
}

JointValues random_joint_values(const Robot& robot, Random& random) {
  std::vector<double> free;
  for (const Index index : robot.free_joints()) {
    const auto [lower, upper] = range_of(robot.joints[index]);
    free.push_back(random.uniform(lower, upper));
  }
  return joint_values(robot, free);
}

std::vector<Motion> link_motions(const Robot& robot, const JointValues& values) {
  std::vector<Motion> motions(robot.links.size(), Motion::Identity());
  std::vector<bool> known(robot.links.size(), true);
  for (const Joint& joint : robot.joints) known[joint.child] = false;
  // Each pass places at least one link, since there are no loops.
  for (bool again = true; again;) {
    again = false;
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const Joint& joint = robot.joints[j];
      if (known[joint.child]) continue;
      again = true;
      if (!known[joint.parent]) continue;
      motions[joint.child] = motions[joint.parent] * motion_of(joint, values[j]);
      known[joint.child] = true;
    }
  }
  return motions;
}

}  // namespace orchard::robot
