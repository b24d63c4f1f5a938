#include "robot/command/robot_files.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "orchard/geometry/atomic_file.h"
#include "robot/format_text.h"
#include "spheres/set_files.h"
#include "spheres/sphere_views.h"

namespace orchard::apps {
namespace {

constexpr const char* kViews = "-robot";
constexpr const char* kPicture = "-robot.png";

// Formats that share files write them once.
void write_formats(const RobotCommand& command, const robot::SphereModel& model, Outputs& outputs) {
  robot::FormatOptions options{.prefix = command.urdf.stem().string(),
                               .tool_frames = command.tool_frames,
                               .positions = parse_joints(command.joints),
                               .max_acceleration = command.acceleration,
                               .max_jerk = command.jerk,
                               .resolution = command.resolution};
  std::vector<std::string> written;
  for (const std::string& format : command.exports.empty() ? kUsualFormats : command.exports)
    for (const robot::FormatFile& file : robot::write_format(format, model, options)) {
      if (std::find(written.begin(), written.end(), file.name) != written.end()) continue;
      written.push_back(file.name);
      write_file(outputs.add(file.name, file.what), file.text);
    }
}

// A tree for each link: over a cover with the link's triangles, otherwise over the union of the spheres.
void write_trees(const RobotCommand& command, const std::vector<robot::LinkShape>& shapes,
                 const robot::SphereModel& model, Outputs& outputs) {
  const std::vector<std::string> stems = robot::file_stems(model);
  std::vector<std::string> trees(model.groups.size());
  tbb::parallel_for(std::size_t{0}, trees.size(), [&](std::size_t g) {
    const SphereGroup& group = model.groups[g];
    const auto shape = std::find_if(shapes.begin(), shapes.end(), [&](const robot::LinkShape& one) {
      return model.robot->links[one.link].name == group.name;
    });
    const bool covered = shape != shapes.end() && shape->surface.solid() &&
                         audit_spheres(shape->surface, group.spheres,
                                       {.max_cells = 1, .rays = 8, .surface_samples = 8, .sphere_samples = 8})
                             .covered;
    trees[g] = covered ? cover_tree(shape->surface, group.spheres) : union_tree(group.spheres);
  });
  for (std::size_t g = 0; g < trees.size(); ++g)
    write_file(outputs.add(fmt::format("{}-tree-{}.orchard", command.urdf.stem().string(), stems[g]),
                           g == 0 ? "and one for each other link, sphere-trees for the run-time" : ""),
               trees[g]);
}

}  // namespace

std::vector<std::string> robot_file_names(const RobotCommand& command) {
  std::vector<std::string> endings = sphere_view_endings(kViews);
  for (const char* ending :
       {kPicture, "-curobo.yml", "-curobo07.yml", ".xrdf", "-spheres.urdf", ".srdf", "-vamp.json", ".xml",
        "-ballpark.json", "-spheres.csv", "-spheres.json", "-liggghts.in", "-yade.py", "-trajectory.pvd"})
    endings.emplace_back(ending);
  std::vector<std::string> names;
  names.reserve(endings.size());
  for (const std::string& ending : endings) names.push_back(named(command.urdf, ending));
  return names;
}

void write_robot_files(const RobotCommand& command, const std::vector<robot::LinkShape>& shapes,
                       const robot::SphereModel& model, Outputs& outputs) {
  const robot::Robot& robot = *model.robot;
  write_formats(command, model, outputs);
  if (command.trees) write_trees(command, shapes, model, outputs);
  const PosedRobot pose = posed(robot, shapes, model.groups, robot::joint_values(robot, parse_joints(command.joints)));
  const Surface surface(pose.mesh);
  if (command.views) write_sphere_views(command.urdf, kViews, surface, pose.spheres, outputs);
  if (command.picture)
    draw_spheres(named(command.urdf, kPicture), robot.name, command.up, surface, pose.spheres, outputs);
  if (!command.trajectory.empty())
    write_trajectory(robot, shapes, model.groups, read_trajectory(command.trajectory, robot), outputs);
}

std::vector<LinkRow> audit_links(const robot::Robot& robot, const std::vector<robot::LinkShape>& shapes,
                                 const std::vector<SphereGroup>& groups, const Progress& progress) {
  std::vector<LinkRow> rows;
  std::vector<std::vector<Sphere>> spheres;
  for (Index link = 0; link < robot.links.size(); ++link) {
    LinkRow row{.link = robot.links[link].name};
    for (const robot::LinkShape& shape : shapes)
      if (shape.link == link) row.shape = &shape;
    std::vector<Sphere>& own = spheres.emplace_back();
    for (const SphereGroup& group : groups) {
      if (group.name != row.link) continue;
      row.switched_off = group.switched_off;
      own.insert(own.end(), group.spheres.begin(), group.spheres.end());
    }
    row.spheres = static_cast<Index>(own.size());
    if (row.shape == nullptr && own.empty()) {
      spheres.pop_back();
      continue;
    }
    rows.push_back(std::move(row));
  }
  report_progress(progress, "auditing links", 0);
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
    if (rows[i].shape != nullptr && !spheres[i].empty())
      rows[i].audit = audit_spheres(rows[i].shape->surface, spheres[i]);
  });
  return rows;
}

}  // namespace orchard::apps
