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

// That say which spheres are to be made.
void add_fit_options(CLI::App& command, RobotCommand& robot) {
  command
      .add_option(
          "--spheres", robot.spheres,
          "Make this many for all links together. Each link gets one, and the next one goes to the link whose spheres "
          "stick out farthest")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command
      .add_option("--link", robot.links,
                  "Make this many for a link, as NAME=NUMBER; they count among --spheres. May be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--fit", robot.fit,
                  "Promise for each link: cover (hold the whole surface), inside (lie in the solid) or balanced "
                  "(the solid's volume)")
      ->check(CLI::IsMember({"cover", "inside", "balanced"}))
      ->capture_default_str();
  command.add_option("--fit-link", robot.link_fits, "Use another fit for a link, as NAME=FIT. May be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--padding", robot.padding,
                  "Cover every point up to this far from the surface, in metres: added to all radii")
      ->check(NumberValidator(CLI::Range(0.0, 1e3)))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--effort",
          [&robot](const std::string& name) {
            robot.effort = name == "low" ? Effort::low : name == "high" ? Effort::high : Effort::standard;
          },
          "Search effort: low, standard (default) or high")
      ->check(CLI::IsMember({"low", "standard", "high"}));
  command.add_option("--from", robot.from,
                     "Make no spheres. Take those of this file or folder, as audit reads them, and write them in "
                     "other formats");
  command.add_flag("!--no-wrap", robot.wrap,
                   "Refuse links that are no solids even after repair, in place of wrapping them");
}

// That say what files hold.
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
                  "Link that cuRobo, XRDF and VAMP take for the tool; may be repeated (default: the end of the "
                  "longest chain)")
      ->allow_extra_args(false);
  command
      .add_option(
          "--joints", robot.joints,
          "Position at which a joint rests in files, views and the picture, as NAME=VALUE in radians or metres; may be "
          "repeated (default: 0, or as near as its limits allow)")
      ->allow_extra_args(false);
  command
      .add_option("--acceleration", robot.acceleration,
                  "Limit of all joints' accelerations in XRDF and cuRobo's files, which URDF does not have; without "
                  "it there is a marked placeholder")
      ->check(NumberValidator(CLI::Range(1e-6, 1e9)));
  command.add_option("--jerk", robot.jerk, "Limit of all joints' jerks, likewise")
      ->check(NumberValidator(CLI::Range(1e-6, 1e9)));
  command
      .add_option("--buffer", robot.buffer,
                  "Length that cuRobo and XRDF add to all radii, in metres: a number in their files")
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
                      "A folder of packages, or a package, for package:// in URDFs; may be repeated. The folders "
                      "above the URDF are searched anyway")
          ->allow_extra_args(false),
      command.add_flag("--visual", reading.visual,
                       "Of a robot: its visual geometry in place of its collision geometry"),
      command.add_flag("!--ignore-units", reading.dae.units,
                       "Of a robot: take the numbers of .dae files for metres, as some loaders do, whatever unit "
                       "they state"),
      command.add_flag("!--ignore-up", reading.dae.up,
                       "Of a robot: leave .dae files as they are, as some loaders do, whatever axis they say points "
                       "up")};
}

void add_robot(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand(
      "robot", "Make spheres for every link of a URDF, proven, in the formats of planners and simulators");
  RobotCommand& robot = request.robot;
  command.add_option("urdf", robot.urdf, "Robot to read, a .urdf file; meshes may be .stl, .obj, .ply, .off and .dae")
      ->required();
  command.add_option("-o,--output", robot.folder, "Folder that receives all files")->required();
  add_fit_options(command, robot);
  add_robot_reading(command, robot.reading);
  add_file_options(command, robot);
  command
      .add_option("--states", robot.states,
                  "Sample this many joint states to find the pairs of links that need no test. 0 makes no such list")
      ->check(CLI::Range(0, 10'000'000))
      ->capture_default_str();
  command.add_option("--seed", robot.seed, "Seed of all random choices")->capture_default_str();
  command.add_flag("--trees", robot.trees, "Write a sphere-tree for each link, an .orchard file for the run-time");
  command.add_option("--trajectory", robot.trajectory,
                     "Table of joint values to play in ParaView, .csv with the joints' names and perhaps time as its "
                     "header: the robot "
                     "along it, for ParaView");
  command.add_flag("!--no-views", robot.views, "Write no files for ParaView");
  command.add_flag("!--no-picture", robot.picture, "Draw no picture of the robot with its spheres");
  add_report(command, robot.report);
  add_up(command, robot.up);
  add_threads(command, request);
  add_accept(command, robot.accept);
  add_force(command, robot.output);
  add_output_flags(command, robot.output);
  command.footer(
      "Examples:\n  orchard robot data/desk-arm.urdf -o out/desk-arm --spheres 60\n"
      "  orchard robot data/desk-arm.urdf -o out/desk-arm-mujoco --spheres 80 --link gripper=12 --export mjcf,urdf\n"
      "  orchard robot data/desk-arm.urdf -o out/desk-arm-xrdf --from out/desk-arm/desk-arm-curobo.yml --export xrdf");
  command.callback([&request, &command] {
    request.robot.output.run = invocation_of(command, request.typed);
    request.robot.given = given_of(command);
    request.run = [&request] { request.exit_code = orchard::apps::robot(request.robot); };
  });
}

}  // namespace orchard::apps
