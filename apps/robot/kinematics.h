#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/random.h"
#include "robot/robot.h"

namespace orchard::robot {

// The value of each joint, in the order of Robot::joints: radians or metres; 0 for fixed, floating and planar joints,
// whose links stay at their origins.
using JointValues = std::vector<double>;

// All joints from the free ones, in the order of free_joints(): those that mimic follow.
JointValues joint_values(const Robot& robot, std::span<const double> free);

// Free joints by name; the others are 0, or the nearest value that their limits allow. Throws InputError for a name
// that is no free joint, and for a value that is not finite.
JointValues joint_values(const Robot& robot, const std::map<std::string, double>& by_name);

// Uniform between the limits; continuous joints from -pi to pi.
JointValues random_joint_values(const Robot& robot, Random& random);

// Where each link is: from its frame to that of its root.
std::vector<Motion> link_motions(const Robot& robot, const JointValues& values);

}  // namespace orchard::robot
