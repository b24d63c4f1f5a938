#pragma once
#include <string>
#include <vector>

#include "robot/formats.h"

// What writers of several formats have in common.
namespace orchard::robot {

// A number that every reader of YAML and of Python takes for a float: with a point in it.
std::string float_text(double value);
std::string point_text(const Point& point, const char* between);

// A link's name in a file's name: slashes and control characters become '_'. Different for each group.
std::vector<std::string> file_stems(const SphereModel& model);

// "head" as comments, each line behind `mark`.
std::string comments(const SphereModel& model, const char* mark);

// For a comment of XML, which may not hold two dashes in a row.
std::string harmless(std::string text);

// The links that files name as tools: those of the options, or the link at the end of the longest chain of joints that
// move.
std::vector<std::string> tool_frames(const SphereModel& model, const FormatOptions& options);

// Of each link, those after it in the robot's order that need no test with it; of links with spheres.
std::vector<std::pair<std::string, std::vector<std::string>>> ignored_links(const SphereModel& model);

// Of the free joints, in their order.
struct RestingJoint {
  std::string name;
  double position = 0;
};
std::vector<RestingJoint> resting_joints(const SphereModel& model, const FormatOptions& options);

using Files = std::vector<FormatFile>;
Files write_curobo(const SphereModel& model, const FormatOptions& options);
Files write_curobo07(const SphereModel& model, const FormatOptions& options);
Files write_xrdf(const SphereModel& model, const FormatOptions& options);
Files write_srdf(const SphereModel& model, const FormatOptions& options);
Files write_urdf(const SphereModel& model, const FormatOptions& options);
Files write_vamp(const SphereModel& model, const FormatOptions& options);
Files write_mjcf(const SphereModel& model, const FormatOptions& options);
Files write_ballpark(const SphereModel& model, const FormatOptions& options);
Files write_morphit(const SphereModel& model, const FormatOptions& options);
Files write_foam(const SphereModel& model, const FormatOptions& options);
Files write_csv(const SphereModel& model, const FormatOptions& options);
Files write_json(const SphereModel& model, const FormatOptions& options);
Files write_liggghts(const SphereModel& model, const FormatOptions& options);
Files write_lammps(const SphereModel& model, const FormatOptions& options);
Files write_yade(const SphereModel& model, const FormatOptions& options);

}  // namespace orchard::robot
