// Options of the commands that build, measure and use sphere-trees.
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
  add_mesh(command, request, build.mesh, build.reading.input);
  command
      .add_option("-o,--output", build.folder,
                  "Folder that receives the tree, the views and the report, or a file for the tree alone (.orchard or "
                  ".sph)")
      ->required();
  add_mesh_options(command, build.reading);
  add_tree_options(command, build.tree);
  command
      .add_option("--time", build.seconds,
                  "tightened: stop after this many seconds and keep the tightest tree so far, at worst the octree")
      ->check(NumberValidator(CLI::Range(0.0, 1e6)))
      ->excludes(command.get_option("--effort"));
  add_tuning(command, build.tuning, true);
  add_axis_source(command, build.source);
  command.add_option(
      "--from-axis", build.source.axis,
      "Build the tree from this medial axis (.ma, .ply, .obj or a file of another system) instead of computing one");
  add_threads(command, request);
  command.add_flag("!--no-views", build.views, "Do not write files for ParaView");
  command.add_flag("--picture", build.picture, "Also draw the stages from mesh to tree in a .png file");
  add_report(command, build.page);
  command.add_flag("--cost", build.cost, "Print the expected time and memory and build nothing");
  add_list(
      command, "--export", build.exports,
      "Also write sph (spheres as text), json (spheres by level), urdf (collision spheres of a link), npz or csv (a "
      "row for each sphere: x, y, z, radius, inaccuracy, level, parent)",
      {"sph", "json", "urdf", "npz", "csv"});
  command.add_option("--export-level", build.export_level,
                     "Level of the tree that --export urdf writes (default: the deepest)");
  command.add_option("--up", build.up, "Axis of the mesh that points up in the picture and in ParaView")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  add_accept(command, build.accept);
  add_force(command, build.output);
  add_output_flags(command, build.output);
  command.footer(
      "Examples:\n  orchard build data/lamp.obj -o out/lamp --picture\n  orchard build data/lamp.obj -o out/lamp "
      "--spheres 8,64,512 --effort high\n  orchard build scan.stl -o out/scan --wrap --depth 4");
  command.callback([&request, &command] {
    request.build.output.run = invocation_of(command, request.typed);
    request.build.given = given_of(command);
    request.run = [&request] { request.exit_code = orchard::apps::build(request.build); };
  });
}

void add_collide(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("collide", "Test whether two placed bodies touch, level by level of their sphere-trees");
  CollideCommand& collide = request.collide;
  command.add_option("a", collide.a, "Sphere-tree of the first body (.orchard)")->required();
  command.add_option("b", collide.b, "Sphere-tree of the second body; may be the same file")->required();
  command.add_option(
      "--pose", collide.pose,
      "Pose of b: \"tx ty tz qw qx qy qz\", a translation and a unit quaternion (default: where it was built)");
  command.add_option("--pose-a", collide.pose_a, "Pose of a in the same form (default: where it was built)");
  add_output_flags(command, collide.output);
  command.get_option("--quiet")->description("Print the answer only");
  command.footer(
      "The answer and the lower bounds are about the surfaces. A body that lies wholly inside the other does\n"
      "not touch it: the answer is \"no\", and a further line (\"inside\" in JSON) says that it lies inside.\n"
      "\"Separation at most\" is a bound on the distance between the solids.\n"
      "Example:\n  orchard collide out/lamp/lamp.orchard out/ship/ship.orchard --pose \"4 0 0 1 0 0 0\"");
  command.callback([&request, &command] {
    request.collide.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::collide(request.collide); };
  });
}

void add_verify(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("verify", "Prove that a sphere-tree covers a mesh and that its bounds hold");
  VerifyCommand& verify = request.verify;
  command.add_option("tree", verify.tree, "Sphere-tree to prove: .orchard, or .sph of any system in the mesh's frame")
      ->required();
  command.add_option("mesh", verify.mesh, mesh_help("Mesh that the tree was built for"))->required();
  request.meshes.push_back({&verify.mesh, &verify.input});
  add_mesh_input(command, verify.input);
  add_join(command, verify.join);
  command.add_flag(
      "--bbox-center", verify.box_centered,
      "Take the centre of the mesh's bounding box as the origin of the .sph file, as some systems write it");
  add_output_flags(command, verify.output);
  command.footer(
      "The exit code is 1 if something is not proven; each violation is printed.\n"
      "Examples:\n  orchard verify out/lamp/lamp.orchard data/lamp.obj\n  orchard verify other.sph data/lamp.obj "
      "--bbox-center\n  orchard verify out/lamp/lamp.orchard data/lamp.obj --json");
  command.callback([&request, &command] {
    request.verify.output.run = invocation_of(command, request.typed);
    request.run = [&request] { request.exit_code = orchard::apps::verify(request.verify) ? kSucceeded : kFailed; };
  });
}

namespace {

// Of axes alone.
void add_axes_options(CLI::App& command, CompareCommand& compare) {
  command
      .add_option("--vertices", compare.vertices,
                  "axes: simplify each to at most this many balls, and orchard's own to as many as that one then has "
                  "(default: the size of each file)")
      ->check(CLI::Range(1, 100'000'000));
  command.add_option("--csv", compare.csv,
                     "axes: add the rows of this mesh to this .csv file, which may have those of other meshes");
  command
      .add_option("--quality-samples", compare.quality_samples,
                  "axes: number of surface points at which each is measured")
      ->check(CLI::Range(100, 10'000'000))
      ->capture_default_str();
  command.add_option("--samples", compare.samples, "axes: number of surface points from which orchard's own is built")
      ->check(CLI::Range(20, 10'000'000))
      ->capture_default_str();
  command.add_option("--seed", compare.seed, "axes: seed of all random choices")->capture_default_str();
  command.add_flag("--connect", compare.connect,
                   "axes: connect balls that have no cells by their power diagram within the solid");
  add_up(command, compare.up);
}

}  // namespace

void add_compare(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand(
      "compare", "Compare how well sphere-trees, level by level, or medial axes of equal size fit a mesh");
  CompareCommand& compare = request.compare;
  add_mesh(command, request, compare.mesh, compare.reading.input);
  command
      .add_option("files", compare.files,
                  "Sphere-trees in the mesh's frame (.orchard, .sph, or .json lists of spheres by level), or medial "
                  "axes (.ma, .obj, .ply, ..), each of which is compared with orchard's of the same size")
      ->required();
  auto* folder = command.add_option("-o,--output", compare.folder,
                                    "Folder that receives the report, and of axes the table, the picture and orchard's "
                                    "axes");
  add_report(command, compare.report)->needs(folder);
  command.add_option("--plot", compare.plot, "Also plot the table to this .svg file");
  add_axes_options(command, compare);
  add_mesh_options(command, compare.reading);
  add_threads(command, request);
  add_force(command, compare.output)->needs(folder);
  add_output_flags(command, compare.output);
  command.footer(
      "Examples:\n  orchard compare data/lamp.obj out/lamp/lamp.orchard other.sph\n  orchard compare data/lamp.obj "
      "out/lamp/lamp.orchard other.sph --plot out/lamp.svg\n  orchard compare data/lamp.obj spheres.json --json\n"
      "  orchard compare data/lamp.obj other.ma older.ma --vertices 100 -o out/compare --report");
  command.callback([&request, &command] {
    request.compare.output.run = invocation_of(command, request.typed);
    request.compare.given = given_of(command);
    request.run = [&request] { orchard::apps::compare(request.compare); };
  });
}

void add_profile(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("profile", "Measure how fast and how selective a sphere-tree is, level by level");
  ProfileCommand& profile = request.profile;
  command.add_option("a", profile.a, "Sphere-tree of the first body (.orchard)")->required();
  command.add_option("b", profile.b, "Sphere-tree of the second body (default: a second copy of a)");
  command
      .add_option("--flights", profile.flights,
                  "Number of random flights of b past a, of about ten poses each. More flights give steadier figures")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command.add_option("--seed", profile.seed, "Seed of the random flights")->capture_default_str();
  command.add_option("--plot", profile.plot, "Also plot the table to this .svg file");
  command.add_option("--csv", profile.csv, "Write every pose and the answer of each level to this .csv file");
  auto* folder = command.add_option("-o,--output", profile.folder, "Folder that receives the report");
  add_report(command, profile.report)->needs(folder);
  add_force(command, profile.output)->needs(folder);
  add_output_flags(command, profile.output);
  command.footer(
      "Examples:\n  orchard profile out/lamp/lamp.orchard --plot out/profile.svg\n  orchard profile "
      "out/lamp/lamp.orchard out/ship/ship.orchard --flights 1000\n  orchard profile out/lamp/lamp.orchard --csv "
      "out/poses.csv");
  command.callback([&request, &command] {
    request.profile.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::profile(request.profile); };
  });
}

void add_simulate(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("simulate", "Run a scene of moving bodies and trace the collision detector");
  SimulateCommand& simulate = request.simulate;
  command
      .add_option("scene", simulate.scene, "Scene to run: flight, pile, asteroids, robot, box, conveyor or clusters")
      ->required()
      ->check(CLI::IsMember({"flight", "pile", "asteroids", "robot", "box", "conveyor", "clusters"}));
  command.add_option("--tree", simulate.tree, "Sphere-tree of the bodies, an .orchard file (default: a small ship)");
  auto* replay = command.add_option("--replay", simulate.replay,
                                    "Repeat the run in this file, which --record wrote, step by step");
  command
      .add_option("--bodies", simulate.bodies,
                  "Number of bodies in addition to those that the scene always has. 0 uses the scene's own number")
      ->check(CLI::Range(0, 1'000'000))
      ->excludes(replay);
  command.add_option("--frames", simulate.frames, "Number of frames [100; with --replay, as many as were recorded]")
      ->check(CLI::Range(1, 10'000'000));
  command
      .add_option("--budget", simulate.budget,
                  "Limit of the detection of one frame, as tests (20000) or as time (2ms, 500us) (default: no limit)")
      ->excludes(replay);
  command.add_option("--seed", simulate.seed, "Seed of all random choices")->capture_default_str()->excludes(replay);
  command
      .add_option("--record", simulate.record,
                  "Write the motions, and the place where the budget of each step ended, to this file, for --replay")
      ->excludes(replay);
  auto* folder =
      command.add_option("-o,--output", simulate.folder, "Folder that receives the traces and the run for ParaView");
  add_report(command, simulate.report)->needs(folder);
  command.add_flag("!--no-views", simulate.views, "Do not write files for ParaView")->needs(folder);
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
