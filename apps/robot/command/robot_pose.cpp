#include "robot/command/robot_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "command_line/list_option.h"
#include "command_line/number_text.h"
#include "input/input_file.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/ball_tree.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/vtk_writer.h"
#endif

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPoses = 10'000;

// The columns of a table: an index into the free joints, or that of the time.
constexpr std::size_t kTime = static_cast<std::size_t>(-1);

std::vector<std::size_t> columns_of(const std::vector<std::string>& header, const robot::Robot& robot,
                                    const std::string& where) {
  const std::vector<Index> free = robot.free_joints();
  std::vector<std::size_t> columns;
  for (const std::string& name : header) {
    const auto joint = std::find_if(free.begin(), free.end(), [&](Index j) { return robot.joints[j].name == name; });
    if (joint == free.end() && name != "time") {
      std::vector<std::string> names;
      names.reserve(free.size());
      for (const Index j : free) names.push_back(robot.joints[j].name);
      throw InputError(fmt::format("{}: \"{}\" is neither time nor a joint that moves by itself: {}", where, name,
                                   fmt::join(names, ", ")));
    }
    columns.push_back(name == "time" ? kTime : static_cast<std::size_t>(joint - free.begin()));
  }
  return columns;
}

}  // namespace

PosedRobot posed(const robot::Robot& robot, const std::vector<robot::LinkShape>& shapes,
                 const std::vector<SphereGroup>& groups, const robot::JointValues& values) {
  const std::vector<robot::Motion> motions = robot::link_motions(robot, values);
  PosedRobot result;
  for (const robot::LinkShape& shape : shapes) {
    const auto first = static_cast<Index>(result.mesh.vertices.size());
    const TriangleMesh& mesh = shape.surface.mesh();
    for (const Point& vertex : mesh.vertices) result.mesh.vertices.push_back(motions[shape.link] * vertex);
    for (const auto& [a, b, c] : mesh.triangles) result.mesh.triangles.push_back({first + a, first + b, first + c});
  }
  for (const SphereGroup& group : groups)
    for (const Sphere& sphere : group.spheres)
      result.spheres.push_back({motions[*robot.find_link(group.name)] * sphere.center, sphere.radius});
  return result;
}

std::map<std::string, double> parse_joints(const std::vector<std::string>& texts) {
  std::map<std::string, double> values;
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    const auto value = equals == std::string::npos ? std::nullopt : finite_number(text.substr(equals + 1));
    if (!value || equals == 0)
      throw InputError(fmt::format("--joints {}: expected NAME=VALUE, in radians or metres", text));
    values[text.substr(0, equals)] = *value;
  }
  return values;
}

Trajectory read_trajectory(const fs::path& file, const robot::Robot& robot) {
  std::istringstream lines(content_of(file));
  Trajectory result;
  std::vector<std::size_t> columns;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    const std::string where = fmt::format("{}, line {}", file.string(), number);
    const auto items = list_items(line);
    if (!items) throw InputError(where + ": a value is empty; give values with single commas between them");
    if (columns.empty()) {
      columns = columns_of(*items, robot, where);
      continue;
    }
    if (items->size() != columns.size())
      throw InputError(
          fmt::format("{}: the line has {} values, but the header has {}", where, items->size(), columns.size()));
    std::vector<double> free(robot.free_joints().size(), 0);
    double time = static_cast<double>(result.values.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto value = finite_number((*items)[i]);
      if (!value) throw InputError(fmt::format("{}: \"{}\" is no finite number", where, (*items)[i]));
      (columns[i] == kTime ? time : free[columns[i]]) = *value;
    }
    result.times.push_back(time);
    result.values.push_back(robot::joint_values(robot, free));
    if (result.values.size() > kMaxPoses)
      throw InputError(fmt::format("{}: the file has more than {} poses", file.string(), kMaxPoses));
  }
  if (result.values.empty())
    throw InputError(file.string() + ": the file has no pose; it needs a header and a line for each pose");
  return result;
}

#ifdef ORCHARD_HAS_VIZ
void write_trajectory(const robot::Robot& robot, const std::vector<robot::LinkShape>& shapes,
                      const std::vector<SphereGroup>& groups, const Trajectory& trajectory, Outputs& outputs) {
  const std::string prefix = robot.file.stem().string();
  std::string collection =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
  for (std::size_t frame = 0; frame < trajectory.values.size(); ++frame) {
    const PosedRobot pose = posed(robot, shapes, groups, trajectory.values[frame]);
    const std::string stem = fmt::format("{}-frame-{:04}", prefix, frame);
    write_mesh(outputs.add(stem + "-mesh.vtp"), Surface(pose.mesh));
    write_tree_level(outputs.add(stem + "-spheres.vtp"),
                     ball_tree(pose.spheres, static_cast<Index>(std::max<std::size_t>(2, pose.spheres.size()))), 1);
    int part = 0;
    for (const char* what : {"mesh", "spheres"})
      collection += fmt::format("    <DataSet timestep=\"{}\" part=\"{}\" name=\"{}\" file=\"{}-{}.vtp\"/>\n",
                                trajectory.times[frame], part++, what, stem, what);
  }
  write_file(outputs.add(prefix + "-trajectory.pvd", "open this in ParaView: the robot along the trajectory"),
             collection + "  </Collection>\n</VTKFile>\n");
}
#else
void write_trajectory(const robot::Robot&, const std::vector<robot::LinkShape>&, const std::vector<SphereGroup>&,
                      const Trajectory&, Outputs&) {}
#endif

}  // namespace orchard::apps
