// Options of the commands that build, judge and use sphere-trees.
#include <fmt/core.h>

#include <numbers>
#include <optional>

#include "command_line/add_commands.h"
#include "command_line/command_list.h"
#include "command_line/list_option.h"
#include "command_line/number_validator.h"
#include "command_line/shared_options.h"
#include "command_line/tree_options.h"
#include "medial/axis_export.h"

namespace orchard::apps {

void add_build(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("build", "Build the sphere-tree of a triangle mesh");
  BuildCommand& build = request.build;
  add_mesh(command, build.mesh);
  command.add_option("-o,--output", build.folder, "Folder for the tree, the views and the report")->required();
  add_mesh_options(command, build.reading);
  add_tree_options(command, build.options);
  command
      .add_option("--time", build.seconds,
                  "tightened: the tightest tree that there is after so many seconds, at whatever effort; the octree if "
                  "there is none yet")
      ->check(NumberValidator(CLI::Range(0.0, 1e6)))
      ->excludes(command.get_option("--effort"));
  add_tuning(command, build.tuning, true);
  add_axis_source(command, build.source);
  command.add_option("--from-axis", build.source.axis,
                     "Build from this medial axis, a file of any system, instead of one of its own");
  add_threads(command, request);
  command.add_flag("!--no-views", build.views, "Write no files for ParaView");
  command.add_flag("--picture", build.picture, "Draw the pipeline to a .png as well");
  command.add_flag("--report", build.page,
                   "Write a page (.html) as well: picture, tables, plots, options, repairs, times, certificate");
  command.add_flag("--cost", build.cost, "Say what it will cost in time and memory, and build nothing");
  add_list(command, "--export", build.exports, "More files: json (spheres by level), urdf (a link's collision spheres)",
           {"sph", "json", "urdf"});
  command.add_option("--export-level", build.export_level, "Level of the urdf's spheres (default: the last)");
  command.add_option("--up", build.up, "The mesh's axis that points up in the picture and in ParaView")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  add_accept(command, build.accept);
  add_force(command, build.output);
  add_output_flags(command, build.output);
  command.footer("Example:\n  orchard build data/lamp.obj -o out/lamp --picture");
  command.callback([&request, &command] {
    request.build.output.run = invocation_of(command, request.typed);
    request.build.given = given_of(command);
    SphereTreeOptions& options = request.build.options;
    if (!options.spheres.empty()) options.depth = static_cast<Index>(options.spheres.size());
    request.run = [&request] { request.exit_code = orchard::apps::build(request.build); };
  });
}

void add_collide(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("collide", "Ask whether two placed trees' objects touch, level by level");
  CollideCommand& collide = request.collide;
  command.add_option("a", collide.a, "An .orchard file")->required();
  command.add_option("b", collide.b, "Another, or the same")->required();
  command.add_option("--pose", collide.pose, "Where b is: \"tx ty tz qw qx qy qz\", a translation and a quaternion");
  command.add_option("--pose-a", collide.pose_a, "Where a is, in the same form (default: where it was built)");
  add_output_flags(command, collide.output);
  command.get_option("--quiet")->description("Print the answer alone");
  command.footer(
      "The answer is about the surfaces, and so are lower bounds. A body that lies wholly inside the other one does\n"
      "not touch it: the answer is \"no\", and a line of its own (\"inside\" in JSON) says so. \"Separation at most\"\n"
      "bounds the distance between the solids.\n"
      "Example:\n  orchard collide out/lamp/lamp.orchard out/ship/ship.orchard --pose \"4 0 0 1 0 0 0\"");
  command.callback([&request, &command] {
    request.collide.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::collide(request.collide); };
  });
}

void add_verify(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("verify", "Prove that a tree covers a mesh and that its bounds hold");
  VerifyCommand& verify = request.verify;
  command.add_option("tree", verify.tree, "An .orchard file, or an .sph file of any system in the mesh's frame")
      ->required();
  command.add_option("mesh", verify.mesh, "The mesh that it was built for")->required();
  add_join(command, verify.join);
  command.add_flag("--bbox-centre", verify.box_centered,
                   "The .sph file's origin is the centre of the mesh's bounding box, as some systems write it");
  add_output_flags(command, verify.output);
  command.footer(
      "Exit code 1 if anything is not proven; each violation is named.\n"
      "Example:\n  orchard verify out/lamp/lamp.orchard data/lamp.obj");
  command.callback([&request, &command] {
    request.verify.output.run = invocation_of(command, request.typed);
    request.run = [&request] { request.exit_code = orchard::apps::verify(request.verify) ? kSucceeded : kFailed; };
  });
}

void add_compare(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("compare", "Tell which of several trees fits a mesh tightest, level by level");
  CompareCommand& compare = request.compare;
  add_mesh(command, compare.mesh);
  command
      .add_option("trees", compare.trees,
                  "Trees in the mesh's frame: .orchard, .sph, or .json lists of spheres by level")
      ->required();
  command.add_option("--plot", compare.plot, "Draw the table to this .svg file");
  add_mesh_options(command, compare.reading);
  add_output_flags(command, compare.output);
  command.footer("Example:\n  orchard compare data/lamp.obj out/lamp/lamp.orchard other.sph --plot out/lamp.svg");
  command.callback([&request, &command] {
    request.compare.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::compare(request.compare); };
  });
}

void add_profile(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("profile", "Say what a tree buys: decided by level, bounds, microseconds");
  ProfileCommand& profile = request.profile;
  command.add_option("a", profile.a, "An .orchard file")->required();
  command.add_option("b", profile.b, "The other body's (default: another copy of a)");
  command
      .add_option("--flights", profile.flights, "Random flights of b past a, or until they touch; about ten poses each")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command.add_option("--seed", profile.seed, "Of the flights")->capture_default_str();
  command.add_option("--plot", profile.plot, "Draw the table to this .svg file");
  command.add_option("--csv", profile.csv, "Write every pose, and what each level said, to this .csv file");
  add_output_flags(command, profile.output);
  command.footer("Example:\n  orchard profile out/lamp/lamp.orchard --plot out/profile.svg");
  command.callback([&request, &command] {
    request.profile.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::profile(request.profile); };
  });
}

void add_simulate(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("simulate", "Play a scene of moving bodies, and trace what detection does");
  SimulateCommand& simulate = request.simulate;
  command.add_option("scene", simulate.scene, "flight, pile, asteroids, robot, box, conveyor or clusters")
      ->required()
      ->check(CLI::IsMember({"flight", "pile", "asteroids", "robot", "box", "conveyor", "clusters"}));
  command.add_option("--tree", simulate.tree, "The bodies' tree, an .orchard file (default: a small ship's)");
  auto* replay = command.add_option("--replay", simulate.replay, "Run what --record wrote, step for step");
  command.add_option("--bodies", simulate.bodies, "How many, beside what the scene always has (0: as it has them)")
      ->check(CLI::Range(0, 1'000'000))
      ->excludes(replay);
  command.add_option("--frames", simulate.frames, "How many [100, or as many as were recorded]")
      ->check(CLI::Range(1, 10'000'000));
  command
      .add_option(
          "--budget", simulate.budget,
          "Of a frame's detection: tests as the detector counts them, 20000, or time, 2ms or 500us (default: none)")
      ->excludes(replay);
  command.add_option("--seed", simulate.seed, "Of all random choices")->capture_default_str()->excludes(replay);
  command.add_option("--record", simulate.record, "Write the steering and where each step's budget ended to this file")
      ->excludes(replay);
  auto* folder = command.add_option("-o,--output", simulate.folder, "Folder for the traces, and the run for ParaView");
  command.add_flag("!--no-views", simulate.views, "Write no files for ParaView")->needs(folder);
  add_force(command, simulate.output)->needs(folder);
  add_output_flags(command, simulate.output);
  command.footer(
      "Examples:\n  orchard simulate flight --tree out/lamp/lamp.orchard --frames 400 --budget 20000 -o out/flight\n"
      "  orchard simulate pile --budget 2ms --record pile.txt\n  orchard simulate pile --replay pile.txt");
  command.callback([&request, &command] {
    request.simulate.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::simulate(request.simulate); };
  });
}

}  // namespace orchard::apps
