#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "orchard/geometry/error.h"
#include "output/outputs.h"
#include "report/report_page.h"
#include "robot/command/robot_files.h"
#include "robot/command/robot_report.h"
#include "spheres/sphere_views.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kPrefix = "-audit";

std::vector<fs::path> inputs_of(const AuditCommand& command) {
  std::vector<fs::path> inputs{command.mesh};
  if (!fs::is_directory(command.spheres)) inputs.push_back(command.spheres);
  return inputs;
}

std::optional<Destination> destination_of(const AuditCommand& command, const Provenance& provenance) {
  if (command.folder.empty()) return std::nullopt;
  Destination destination{.folder = command.folder,
                          .report = named(command.mesh, "-audit.json"),
                          .provenance = provenance,
                          .force = command.output.force};
  std::vector<std::string> names{named(command.mesh, "-audit.png"), page_name(command.mesh, "audit")};
  for (const std::string& ending : sphere_view_endings(kPrefix)) names.push_back(named(command.mesh, ending));
  check_outputs(destination, names, inputs_of(command));
  return destination;
}

// The set as it is in the file, or with buffers on all radii.
struct AuditedRobot {
  bool buffered = false;
  std::vector<SphereGroup> groups;
  std::vector<LinkRow> rows;
};

std::vector<SphereGroup> with_buffers(std::vector<SphereGroup> groups, std::optional<double> buffer) {
  for (SphereGroup& group : groups) {
    const double own = buffer.value_or(group.buffer);
    for (Sphere& sphere : group.spheres) sphere.radius += own;
    const auto off =
        std::remove_if(group.spheres.begin(), group.spheres.end(), [](const Sphere& s) { return !(s.radius > 0); });
    group.switched_off += static_cast<Index>(group.spheres.end() - off);
    group.spheres.erase(off, group.spheres.end());
  }
  return groups;
}

bool has_buffers(const std::vector<SphereGroup>& groups, std::optional<double> buffer) {
  if (buffer) return *buffer != 0;
  return std::any_of(groups.begin(), groups.end(), [](const SphereGroup& group) { return group.buffer != 0; });
}

// With --link: that one alone.
void choose(const AuditCommand& command, const robot::Robot& robot, SphereFile& file,
            std::vector<robot::LinkShape>& shapes) {
  if (command.link.empty()) return;
  group_named(file, command.spheres, command.link);  // throws if there is none
  std::erase_if(file.groups, [&](const SphereGroup& group) { return group.name != command.link; });
  std::erase_if(shapes, [&](const robot::LinkShape& shape) { return robot.links[shape.link].name != command.link; });
}

void print_audited(const AuditedRobot& set) {
  if (set.buffered) fmt::print("with the buffers on all radii:\n");
  print_rows(set.rows);
  const RobotFigures figures = figures_of(set.rows);
  print_figures(figures);
  if (figures.open_links == 0)
    fmt::print("CLOSED: every point of the surface of all {} links lies in a sphere; proven\n", figures.links);
  else
    fmt::print("OPEN: {} of {} links\n", figures.open_links, figures.links);
}

void write(const AuditCommand& command, const robot::Robot& robot, const std::vector<robot::LinkShape>& shapes,
           const AuditedRobot& set, const Destination& destination, json& report) {
  Outputs outputs(destination);
  const PosedRobot pose = posed(robot, shapes, set.groups, robot::joint_values(robot, std::map<std::string, double>{}));
  const Surface surface(pose.mesh);
  write_sphere_views(command.mesh, kPrefix, surface, pose.spheres, outputs);
  if (command.picture || command.report) draw_holes(command.mesh, command.up, surface, pose.spheres, outputs);
  outputs.add_report(report, "this report as JSON");
  if (command.report)
    write_report_page(page_name(command.mesh, "audit"),
                      page_of(report, outputs.take(named(command.mesh, "-audit.png"), command.picture)), outputs);
  outputs.commit();
  if (!command.output.quiet && !command.output.json) outputs.print();
}

}  // namespace

ExitCode audit_robot(const AuditCommand& command) {
  if (!fs::is_directory(command.spheres)) check_input(command.spheres);
  check_input(command.mesh);
  const Provenance provenance = provenance_of(command.output.run, inputs_of(command));
  const std::optional<Destination> destination = destination_of(command, provenance);
  ProgressBar bar(!command.output.quiet && !command.output.json);
  const robot::Robot robot = robot::read_urdf(command.mesh, urdf_options(command.reading));
  SphereFile file = read_sphere_file(command.spheres);
  std::vector<std::string> left_out = robot::place_in_links(robot, file, command.spheres);
  if (file.groups.empty())
    throw InputError(
        fmt::format("{}: no sphere belongs to a link of {}", command.spheres.string(), command.mesh.string()));
  std::vector<robot::LinkShape> shapes =
      robot::link_shapes(robot, shape_options(command.reading, command.wrap, command.join), bar.callback());
  choose(command, robot, file, shapes);
  std::vector<std::string> notes = notes_of(robot, shapes);
  notes.insert(notes.end(), left_out.begin(), left_out.end());
  std::vector<AuditedRobot> sets{{false, file.groups, {}}};
  if (has_buffers(file.groups, command.buffer)) sets.push_back({true, with_buffers(file.groups, command.buffer), {}});
  for (AuditedRobot& set : sets) set.rows = audit_links(robot, shapes, set.groups, bar.callback());
  bar.clear();
  json report{{"format", file.format}, {"robot", robot.name}, {"notes", notes}, {"sets", json::array()}};
  bool open = false;
  for (const AuditedRobot& set : sets) {
    json links = json::array();
    for (const LinkRow& row : set.rows) links.push_back(to_json(row));
    report["sets"].push_back(
        {{"buffered", set.buffered}, {"links", std::move(links)}, {"whole", to_json(figures_of(set.rows))}});
    open = open || figures_of(set.rows).open_links > 0;
  }
  report["provenance"] = to_json(provenance);
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (!command.output.json && !command.output.quiet) {
    for (const std::string& note : notes) fmt::print("{}\n", note);
    fmt::print("{} ({}) beside {}\n", command.spheres.string(), file.format, command.mesh.string());
    for (const AuditedRobot& set : sets) print_audited(set);
  }
  if (destination) write(command, robot, shapes, sets.back(), *destination, report);
  return open ? kAuditOpen : kSucceeded;
}

}  // namespace orchard::apps
