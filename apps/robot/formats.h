#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "robot/robot.h"
#include "robot/self_collision.h"
#include "spheres/sphere_files.h"

// A robot's spheres in the formats of planners and simulators.
namespace orchard::robot {

// What there is to write. Numbers are written in the fewest digits that read back as the same double, which rounded()
// keeps few.
struct SphereModel {
  const Robot* robot = nullptr;
  std::vector<apps::SphereGroup> groups;  // of links, in the links' frames, in the robot's order; all with spheres
  std::vector<Inertial> bodies;           // of each group, for formats that have masses
  std::optional<SelfCollision> self;      // nothing: it was not sampled
  double buffer = 0;                      // for the readers to add to all radii; metres
  std::vector<std::string> head;          // what files say about themselves, lines of ASCII
};

struct FormatOptions {
  std::string prefix;                         // of the files' names
  std::vector<std::string> tool_frames{};     // links; empty: the last link of the longest chain
  std::map<std::string, double> positions{};  // of joints, where they rest; others as joint_values() has them
  std::optional<double> max_acceleration{};   // of XRDF and cuRobo, rad/s^2 or m/s^2; nothing: 15, marked as assumed
  std::optional<double> max_jerk{};           // likewise, rad/s^3 or m/s^3; nothing: 500
  Index resolution = 32;                      // of VAMP's motion checks
};

struct FormatFile {
  std::string name, text;
  std::string what;  // it is, for the list of files that were written
};

struct Format {
  const char* name;
  const char* description;
  std::vector<FormatFile> (*write)(const SphereModel& model, const FormatOptions& options);
};

// All of them, ordered as pages list them.
std::span<const Format> formats();

// The files of a format by its name. Precondition: formats() has it.
std::vector<FormatFile> write_format(const std::string& format, const SphereModel& model, const FormatOptions& options);

// How often each pair touches, and what follows from it.
nlohmann::ordered_json to_json(const SelfCollision& self, const Robot& robot);

// Moves the spheres of a file into the frames of the links, one group for each link, in the robot's order: those that
// are in the frame of a collision element or of its mesh. Groups of links that the robot does not have are taken out;
// returns a line for each of them. Throws InputError for an element that the link does not have, and for a mesh whose
// scale differs between axes, since spheres would be none.
std::vector<std::string> place_in_links(const Robot& robot, apps::SphereFile& spheres,
                                        const std::filesystem::path& file);

}  // namespace orchard::robot
