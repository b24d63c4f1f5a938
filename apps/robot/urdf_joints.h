#pragma once
#include <tinyxml2.h>

#include "robot/robot.h"

namespace orchard::robot {

// Adds the joints of a URDF to a robot that has its links; lines of what is unusual go to Robot::notes. Throws
// InputError, with file and line, for joints without a known type, parent or child, for links with two parents, for
// loops, and for mimics of what does not move by itself.
void read_joints(const tinyxml2::XMLElement& root, Robot& robot);

}  // namespace orchard::robot
