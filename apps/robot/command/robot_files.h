#pragma once
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "output/outputs.h"
#include "robot/command/robot_pose.h"
#include "robot/command/robot_report.h"

// What `orchard robot` writes, and how links are audited.
namespace orchard::apps {

// Formats that are written unless --export says which.
inline const std::vector<std::string> kUsualFormats{"curobo", "xrdf", "vamp", "mjcf", "csv", "json"};

// The names that are known before anything is read: files of single links are not among them.
std::vector<std::string> robot_file_names(const RobotCommand& command);

// Formats, trees, views, picture and trajectory, each as the command asks for it.
void write_robot_files(const RobotCommand& command, const std::vector<robot::LinkShape>& shapes,
                       const robot::SphereModel& model, Outputs& outputs);

// A row for each link with geometry or with spheres, in the robot's order.
std::vector<LinkRow> audit_links(const robot::Robot& robot, const std::vector<robot::LinkShape>& shapes,
                                 const std::vector<SphereGroup>& groups, const Progress& progress);

}  // namespace orchard::apps
