// Options of the commands that read robots.
#include <fmt/format.h>

#include "command_line/add_commands.h"
#include "command_line/command_list.h"
#include "command_line/list_option.h"
#include "command_line/number_validator.h"
#include "command_line/shared_options.h"
#include "robot/command/robot_files.h"

namespace orchard::apps {
namespace {

// Options for the spheres.
void add_fit_options(CLI::App& command, RobotCommand& robot) {
  command
      .add_option(
          "--spheres", robot.spheres,
          "Number of spheres of all links together. Each link gets one, and each further one goes to the link whose "
          "spheres protrude farthest")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command
      .add_option("--link", robot.links,
                  "NAME=NUMBER: number of spheres of this link, which are part of --spheres. May be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--fit", robot.fit,
                  "What the spheres of each link promise: cover (they contain the whole surface), inside (they lie in "
                  "the solid) or balanced (they have the solid's volume)")
      ->check(CLI::IsMember({"cover", "inside", "balanced"}))
      ->capture_default_str();
  command.add_option("--fit-link", robot.link_fits, "NAME=FIT: fit of this link, in place of --fit. May be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--padding", robot.padding,
                  "Cover every point up to this distance from the surface, in metres, by adding it to all radii")
      ->check(NumberValidator(CLI::Range(0.0, 1e3)))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--effort",
          [&robot](const std::string& name) {
            robot.effort = name == "low" ? Effort::low : name == "high" ? Effort::high : Effort::standard;
          },
          "How long to search (default: standard)")
      ->check(CLI::IsMember({"low", "standard", "high"}));
  command.add_option(
      "--from", robot.from,
      "Use the spheres of this file or folder, in any format that audit reads, instead of making some, and "
      "write them in other formats");
  command.add_flag("!--no-wrap", robot.wrap,
                   "Refuse links that are not solids even after repair, instead of wrapping them");
}

// Options for the content of the files.
void add_file_options(CLI::App& command, RobotCommand& robot) {
  std::vector<std::string> names;
  std::string help = "Write these formats";
  for (const robot::Format& format : robot::formats()) {
    names.emplace_back(format.name);
    help += fmt::format("{} {} ({})", names.size() == 1 ? ":" : ",", format.name, format.description);
  }
  help += fmt::format("; default: {}", fmt::join(kUsualFormats, ","));
  add_list(command, "--export", robot.exports, help, names);
  command
      .add_option("--tool-frame", robot.tool_frames,
                  "Link that is the tool in the files of cuRobo, XRDF and VAMP (default: the end of the longest "
                  "chain). May be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--joints", robot.joints,
                  "NAME=VALUE: resting position of this joint in files, views and the picture, in radians or metres "
                  "(default: 0, "
                  "or as near as its limits allow). May be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--acceleration", robot.acceleration,
                  "Limit of the acceleration of all joints, for XRDF and cuRobo, because a URDF has none (default: 15, "
                  "cuRobo's own, with a comment that says so)")
      ->check(NumberValidator(CLI::Range(1e-6, 1e9)));
  command
      .add_option("--jerk", robot.jerk, "Limit of the jerk of all joints, for the same files (default: 500, likewise)")
      ->check(NumberValidator(CLI::Range(1e-6, 1e9)));
  command
      .add_option("--buffer", robot.buffer,
                  "Length in metres that planners add to all radii. It is written to the files of cuRobo and XRDF")
      ->check(NumberValidator(CLI::Range(-1e3, 1e3)))
      ->capture_default_str();
  command.add_option("--resolution", robot.resolution, "Resolution of VAMP's motion checks")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  command
      .add_option("--density", robot.density,
                  "Density of links whose URDF has no usable inertia, in kg/m^3, for formats that have masses")
      ->check(NumberValidator(CLI::Range(1e-9, 1e9)))
      ->capture_default_str();
}

}  // namespace

std::vector<CLI::Option*> add_robot_reading(CLI::App& command, RobotReading& reading) {
  return {
      command
          .add_option("--package-path", reading.packages,
                      "Folder of packages, or of one package, to search for package:// in URDFs, in addition to the "
                      "folders above the URDF. May be repeated")
          ->allow_extra_args(false),
      command.add_flag("--visual", reading.visual,
                       "Robots: use the visual geometry in place of the collision geometry"),
      command.add_flag("!--ignore-units", reading.dae.units,
                       "Robots: ignore the unit of .dae files, as some loaders do, and read their numbers as metres"),
      command.add_flag("!--ignore-up", reading.dae.up,
                       "Robots: ignore the axis that points up in .dae files, as some loaders do")};
}

void add_robot(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand(
      "robot", "Make spheres with a promise for every link of a URDF, in the formats of planners and simulators");
  RobotCommand& robot = request.robot;
  command.add_option("urdf", robot.urdf, "Robot to read, a .urdf file; meshes may be .stl, .obj, .ply, .off and .dae")
      ->required();
  command.add_option("-o,--output", robot.folder, "Folder that receives all files")->required();
  add_fit_options(command, robot);
  add_robot_reading(command, robot.reading);
  add_file_options(command, robot);
  command
      .add_option(
          "--states", robot.states,
          "Number of random joint states that are tested to find the pairs of links that need no test. 0 finds none")
      ->check(CLI::Range(0, 10'000'000))
      ->capture_default_str();
  command.add_option("--seed", robot.seed, "Seed of all random choices")->capture_default_str();
  command.add_flag("--trees", robot.trees, "Write a sphere-tree for each link, an .orchard file for the run-time");
  command.add_option("--trajectory", robot.trajectory,
                     "Table of joint values to play in ParaView: a .csv file whose header names the joints and, "
                     "optionally, time");
  command.add_flag("!--no-views", robot.views, "Do not write files for ParaView");
  command.add_flag("!--no-picture", robot.picture, "Do not draw the robot with its spheres");
  add_report(command, robot.report);
  add_up(command, robot.up);
  add_threads(command, request);
  add_accept(command, robot.accept);
  add_force(command, robot.output);
  add_output_flags(command, robot.output);
  command.footer(
      "Examples:\n  orchard robot data/desk-arm.urdf -o out/desk-arm --spheres 60\n"
      "  orchard robot data/desk-arm.urdf -o out/mujoco --spheres 80 --link gripper=12 --export mjcf,urdf\n"
      "  orchard robot data/desk-arm.urdf -o out/xrdf --from out/desk-arm/desk-arm-curobo.yml --export xrdf");
  command.callback([&request, &command] {
    request.robot.output.run = invocation_of(command, request.typed);
    request.robot.given = given_of(command);
    request.run = [&request] { request.exit_code = orchard::apps::robot(request.robot); };
  });
}

}  // namespace orchard::apps
