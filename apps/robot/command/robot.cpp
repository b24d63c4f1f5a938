#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "orchard/geometry/error.h"
#include "output/outputs.h"
#include "output/promises.h"
#include "report/report_page.h"
#include "robot/command/robot_files.h"
#include "robot/command/robot_report.h"
#include "robot/link_fit.h"
#include "spheres/spheres_output.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::array kFits{SphereFit::cover, SphereFit::inside, SphereFit::balanced};

bool given(const RobotCommand& command, const char* option) {
  return std::find(command.given.begin(), command.given.end(), option) != command.given.end();
}

// What is refused before anything is read.
void check(const RobotCommand& command) {
  check_input(command.urdf);
  if (!command.trajectory.empty()) check_input(command.trajectory);
  if (command.from.empty()) return;
  if (!fs::is_directory(command.from)) check_input(command.from);
  for (const char* option : {"spheres", "fit", "link", "fit-link", "effort", "padding"})
    if (given(command, option))
      throw InputError(fmt::format("--{} has no effect with --from, which takes the spheres as they are", option));
}

Destination destination_of(const RobotCommand& command) {
  std::vector<fs::path> inputs{command.urdf};
  if (!command.from.empty() && !fs::is_directory(command.from)) inputs.push_back(command.from);
  if (!command.trajectory.empty()) inputs.push_back(command.trajectory);
  Destination destination{.folder = command.folder,
                          .report = named(command.urdf, "-robot.json"),
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  std::vector<std::string> names = robot_file_names(command);
  names.push_back(page_name(command.urdf, "robot"));
  check_outputs(destination, names, inputs);
  return destination;
}

// The link of "NAME=VALUE", and the value.
std::pair<Index, std::string> link_and_value(const robot::Robot& robot, const std::string& text, const char* option) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos) throw InputError(fmt::format("{} {}: expected NAME=VALUE", option, text));
  const auto link = robot.find_link(text.substr(0, equals));
  if (link) return {*link, text.substr(equals + 1)};
  std::vector<std::string> names;
  for (const robot::Link& one : robot.links) names.push_back(one.name);
  throw InputError(fmt::format("{} {}: {} has no link {}: {}", option, text, robot.file.string(),
                               text.substr(0, equals), fmt::join(names, ", ")));
}

SphereFit fit_named(const std::string& text, const std::string& where) {
  for (const SphereFit fit : kFits)
    if (text == name(fit)) return fit;
  throw InputError(where + ": a fit is cover, inside or balanced");
}

robot::FitOptions fit_options(const RobotCommand& command, const robot::Robot& robot) {
  robot::FitOptions options{.spheres = command.spheres,
                            .fit = fit_named(command.fit, "--fit " + command.fit),
                            .effort = command.effort,
                            .padding = command.padding,
                            .seed = command.seed};
  for (const std::string& text : command.links) {
    const auto [link, value] = link_and_value(robot, text, "--link");
    Index number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size() || number < 1 || number > kMaxSetSpheres)
      throw InputError(fmt::format("--link {}: expected a number from 1 to {}", text, kMaxSetSpheres));
    options.spheres_of[link] = number;
  }
  for (const std::string& text : command.link_fits) {
    const auto [link, value] = link_and_value(robot, text, "--fit-link");
    options.fit_of[link] = fit_named(value, "--fit-link " + text);
  }
  return options;
}

// What the command has made by the time that it writes.
struct Made {
  robot::Robot robot;
  std::vector<robot::LinkShape> shapes;
  robot::SphereModel model;
  std::vector<LinkRow> rows;
  std::vector<std::string> notes;
  Broken broken;
};

void fit(const RobotCommand& command, const Progress& progress, Made& made) {
  const robot::FitOptions options = fit_options(command, made.robot);
  const std::vector<robot::LinkFit> fits = robot::fit_links(made.robot, made.shapes, options, progress);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const std::string& link = made.robot.links[made.shapes[i].link].name;
    SphereGroup group;
    group.name = link;
    group.spheres = fits[i].spheres;
    made.rows.push_back({.link = link,
                         .spheres = static_cast<Index>(group.spheres.size()),
                         .fit = name(fits[i].fit),
                         .kept = fits[i].kept,
                         .grown = fits[i].grown,
                         .shape = &made.shapes[i],
                         .audit = fits[i].audit});
    if (!fits[i].kept)
      made.broken.what.push_back(fmt::format("link {}: the promise of {} is not proven", link, name(fits[i].fit)));
    if (fits[i].grown > 0)
      made.notes.push_back(
          fmt::format("link {}: all radii are larger by {:.2g} m, so that everything is held", link, fits[i].grown));
    made.model.groups.push_back(std::move(group));
  }
}

// The spheres of --from on the robot's links.
std::vector<SphereGroup> read_groups(const RobotCommand& command, Made& made) {
  SphereFile file = read_sphere_file(command.from);
  for (std::string& note : robot::place_in_links(made.robot, file, command.from)) made.notes.push_back(std::move(note));
  std::erase_if(file.groups, [](const SphereGroup& group) { return group.spheres.empty(); });
  if (file.groups.empty())
    throw InputError(
        fmt::format("{}: no sphere belongs to a link of {}", command.from.string(), command.urdf.string()));
  return std::move(file.groups);
}

// What can be wrong with options and files beside the robot, before the long work.
void check_robot(const RobotCommand& command, Made& made) {
  fit_options(command, made.robot);
  robot::joint_values(made.robot, parse_joints(command.joints));
  if (!command.trajectory.empty()) read_trajectory(command.trajectory, made.robot);
  for (const std::string& link : command.tool_frames)
    if (!made.robot.find_link(link))
      throw InputError(fmt::format("--tool-frame {}: {} has no such link", link, command.urdf.string()));
  if (!command.from.empty()) made.model.groups = read_groups(command, made);
}

// Shapes whose links have spheres, and these.
void sample(const RobotCommand& command, const Progress& progress, Made& made) {
  if (command.states == 0) return;
  std::vector<std::vector<Sphere>> spheres(made.shapes.size());
  for (std::size_t i = 0; i < made.shapes.size(); ++i)
    for (const SphereGroup& group : made.model.groups)
      if (group.name == made.robot.links[made.shapes[i].link].name) spheres[i] = group.spheres;
  made.model.self = robot::sample_self_collision(made.robot, made.shapes, spheres,
                                                 {.states = command.states, .seed = command.seed}, progress);
}

std::string promise_of(const RobotCommand& command, const Made& made) {
  if (!command.from.empty()) return fmt::format("as in {}", command.from.filename().string());
  const bool covers =
      std::all_of(made.rows.begin(), made.rows.end(), [](const LinkRow& row) { return row.fit == "cover"; });
  const std::string padding =
      command.padding > 0 ? fmt::format(", with everything up to {:g} m from it,", command.padding) : "";
  return covers ? fmt::format(
                      "every point of the surface of every link{} lies in a sphere of that link, whether a "
                      "reader holds the numbers as double or as float",
                      padding)
                : "each link's fit is kept as the report says";
}

Made make(const RobotCommand& command, const Provenance& provenance, const Progress& progress) {
  Made made;
  made.robot = robot::read_urdf(command.urdf, urdf_options(command.reading));
  check_robot(command, made);
  made.shapes = robot::link_shapes(made.robot, shape_options(command.reading, command.wrap), progress);
  if (made.shapes.empty())
    throw InputError(fmt::format("{}: no link has {} geometry", command.urdf.string(),
                                 command.reading.visual ? "visual" : "collision"));
  for (std::string& note : notes_of(made.robot, made.shapes)) made.notes.push_back(std::move(note));
  if (command.from.empty())
    fit(command, progress, made);
  else
    made.rows = audit_links(made.robot, made.shapes, made.model.groups, progress);
  made.model.robot = &made.robot;
  sample(command, progress, made);
  made.model.buffer = command.buffer;
  for (const SphereGroup& group : made.model.groups) {
    const auto shape = std::find_if(made.shapes.begin(), made.shapes.end(), [&](const robot::LinkShape& one) {
      return made.robot.links[one.link].name == group.name;
    });
    made.model.bodies.push_back(robot::body_of(made.robot.links[*made.robot.find_link(group.name)],
                                               shape == made.shapes.end() ? nullptr : &*shape, group.spheres,
                                               command.density));
  }
  made.model.head = {fmt::format("{} spheres: {}", figures_of(made.rows).spheres, promise_of(command, made)),
                     line_of(provenance)};
  return made;
}

json report_of(const Made& made) {
  json report{{"robot", made.robot.name},
              {"links", json::array()},
              {"whole", to_json(figures_of(made.rows))},
              {"notes", made.notes},
              {"promise_kept", made.broken.none()},
              {"broken", made.broken.what}};
  for (const LinkRow& row : made.rows) report["links"].push_back(to_json(row));
  if (made.model.self) report["self_collision"] = robot::to_json(*made.model.self, made.robot);
  return report;
}

}  // namespace

ExitCode robot(const RobotCommand& command) {
  check(command);
  const Destination destination = destination_of(command);
  const bool talk = !command.output.quiet && !command.output.json;
  ProgressBar bar(talk);
  const Stopwatch watch;
  Made made = make(command, destination.provenance, bar.callback());
  made.model.robot = &made.robot;
  bar.clear();
  Outputs outputs(destination);
  write_robot_files(command, made.shapes, made.model, outputs);
  json report = report_of(made);
  report["seconds"] = watch.seconds();
  outputs.add_report(report, "this report as JSON");
  if (command.report)
    write_report_page(page_name(command.urdf, "robot"),
                      page_of(report, outputs.take(named(command.urdf, "-robot.png"), true)), outputs);
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (talk) {
    for (const std::string& note : made.notes) fmt::print("{}\n", note);
    print_rows(made.rows);
    print_figures(figures_of(made.rows));
    if (made.model.self) print_self_collision(*made.model.self, made.robot);
    outputs.print();
    if (made.broken.none() && command.from.empty()) fmt::print("PROMISED: {}; proven\n", promise_of(command, made));
  }
  if (!made.broken.none()) fmt::print(stderr, "orchard: {}: {}\n", command.urdf.string(), in_one_line(made.broken));
  return exit_code(made.broken, command.accept);
}

}  // namespace orchard::apps
