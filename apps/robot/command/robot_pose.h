#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "orchard/geometry/surface.h"
#include "output/outputs.h"
#include "robot/kinematics.h"
#include "robot/link_shape.h"
#include "spheres/sphere_files.h"

// A robot in a pose, as views and pictures have it.
namespace orchard::apps {

struct PosedRobot {
  TriangleMesh mesh;
  std::vector<Sphere> spheres;
};

PosedRobot posed(const robot::Robot& robot, const std::vector<robot::LinkShape>& shapes,
                 const std::vector<SphereGroup>& groups, const robot::JointValues& values);

// "NAME=VALUE" each. Throws InputError for what is not.
std::map<std::string, double> parse_joints(const std::vector<std::string>& texts);

// A table of joint values, one pose a line: the header names free joints of the robot, and may have a column `time`.
struct Trajectory {
  std::vector<double> times;  // or the numbers of the lines
  std::vector<robot::JointValues> values;
};
// Throws InputError, with file and line, for what is no such table, and for more than 10,000 poses.
Trajectory read_trajectory(const std::filesystem::path& file, const robot::Robot& robot);

// ROBOT-frame-N-mesh.vtp and -spheres.vtp of each pose, and ROBOT-trajectory.pvd, which plays them.
void write_trajectory(const robot::Robot& robot, const std::vector<robot::LinkShape>& shapes,
                      const std::vector<SphereGroup>& groups, const Trajectory& trajectory, Outputs& outputs);

}  // namespace orchard::apps
