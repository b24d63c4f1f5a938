// Options of the commands that build, measure and use medial axes.
#include <fmt/core.h>

#include <numbers>
#include <optional>

#include "command_line/add_commands.h"
#include "command_line/command_list.h"
#include "command_line/list_option.h"
#include "command_line/number_validator.h"
#include "command_line/shared_options.h"
#include "command_line/sweep_option.h"
#include "command_line/tree_options.h"
#include "medial/axis_export.h"
#include "medial/axis_importance.h"
#include "orchard/geometry/noise.h"

namespace orchard::apps {
namespace {

Relaxation relaxation_named(const std::string& name) {
  return name == "clusters"    ? Relaxation::clusters
         : name == "neighbors" ? Relaxation::neighbors
                               : Relaxation::automatic;
}

void add_sampling_options(CLI::App& command, SampleCommand& sample) {
  command.add_option("--samples", sample.samples, "Total number of surface points")
      ->check(CLI::Range(20, 10'000'000))
      ->capture_default_str();
  command.add_option("--edge-samples", sample.edge_samples, "Number of these points on edges (default: a fifth)")
      ->check(CLI::Range(0, 10'000'000));
  command
      .add_option("--iterations", sample.iterations, "Rounds of relaxation. More rounds space the points more evenly")
      ->check(CLI::Range(0, 10'000))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--relaxation", [&sample](const std::string& name) { sample.relaxation = relaxation_named(name); },
          "Which points repel each other: those of one coplanar cluster (clusters, for designed parts), all near ones "
          "across "
          "faces (neighbors, for scans), or those that suit the mesh (automatic, default)")
      ->check(CLI::IsMember({"automatic", "clusters", "neighbors"}));
  command
      .add_option("--cluster-angle", sample.cluster_degrees,
                  "Largest angle in degrees between the normals of one cluster (default: 0.0057). Higher values treat "
                  "curved regions as one")
      ->check(NumberValidator(CLI::Range(0.0, 90.0)));
  command
      .add_option("--crease-angle", sample.crease_degrees,
                  "Smallest angle in degrees at which an edge of a scan gets edge points [28.6]")
      ->check(NumberValidator(CLI::Range(0.0, 180.0)));
  command.add_option("--seed", sample.seed, "Seed of the random points")->capture_default_str();
  add_join(command, sample.join);
}

void add_sweep_tree(CLI::App& command, std::optional<TreeRequest>& tree) {
  const auto wanted = [&tree]() -> TreeRequest& {
    if (!tree) tree.emplace();
    return *tree;
  };
  command
      .add_option_function<std::string>(
          "--tree",
          [wanted](const std::string& method) {
            wanted().method = method == "merging" ? TreeMethod::merging : TreeMethod::tightened;
          },
          "With --sweep: also build this kind of sphere-tree from each axis and report how tight it is")
      ->check(CLI::IsMember({"tightened", "merging"}));
  command
      .add_option_function<Index>(
          "--tree-depth", [wanted](Index depth) { wanted().depth = depth; },
          "Levels below the root of the tree of --tree [3]")
      ->check(CLI::Range(1, 10));
}

void add_sweep(CLI::App& command, MedialCommand& medial) {
  command
      .add_option("--sweep", medial.sweep,
                  "NAME=A,B,..: build once for each value of an option, such as samples, vertices or 'prune angle', "
                  "and compare. May "
                  "be repeated. Runs that the folder has already are not computed again")
      ->allow_extra_args(false);
  command.add_flag("--keep", medial.keep,
                   "With --sweep: also keep the axis and report of each run, in MODEL-sweep/NAME=VALUE,..");
  command
      .add_option("--sort-by", medial.best,
                  "Measure by which the rows of --sweep are sorted, best first. Rows with the right topology come "
                  "before the others")
      ->capture_default_str();
  add_sweep_tree(command, medial.tree);
}

void add_other_axis(CLI::App& command, MedialCommand& medial) {
  CLI::Option* axis = command.add_option("--axis", medial.axis,
                                         "Measure or convert this axis instead of building one (.ma, .obj, .ply, .off, "
                                         ".sph, .swc or text; docs/reference/formats.md)");
  command
      .add_flag(
          "--connect", medial.connect,
          "With --axis: connect balls without edges and triangles by the cells of their power diagram in the solid")
      ->needs(axis);
  add_list(command, "--export", medial.exports,
           "Also write the axis in these formats, as MODEL-axis.npz and so on; with --axis, as AXIS-converted.npz",
           axis_export_kinds());
}

void add_features(CLI::App& command, MedialCommand& medial) {
  command.add_option("--features", medial.features,
                     "Feature edges to which sheets extend, in place of those that orchard finds: lines of an .obj "
                     "file along edges of the mesh");
}

void add_few_balls(CLI::App& command, MedialCommand& medial) {
  CLI::Option* vertices =
      command
          .add_option("--vertices", medial.few_vertices,
                      "Also write the axis simplified to at most this many balls: MODEL-simplified.ma, .ply and .obj")
          ->check(CLI::Range(1, 100'000'000));
  command
      .add_option("--error", medial.few_error,
                  "Also write the axis simplified to the fewest balls within this error: the two-sided distance "
                  "between the surface and the envelope of the balls, in percent of the diagonal")
      ->check(NumberValidator(CLI::Range(1e-4, 100.0)))
      ->excludes(vertices);
  command
      .add_option("--balls", medial.few_kind,
                  "Balls of the simplified axis: medial (default; centres lie in the solid, each radius is the "
                  "distance to the surface up to the error, and the volume is kept) or free (nearer to the surface "
                  "where there are too few balls)")
      ->check(CLI::IsMember({"medial", "free"}))
      ->capture_default_str();
  add_list(
      command, "--importance", medial.importance,
      "Also measure how much each ball matters, by these measures of --prune, as arrays of the views and of --export "
      "npz and csv",
      importance_names());
  command
      .add_option("--prune-curve", medial.prune_curve,
                  "Also prune the axis by this measure at ever larger values, and write error and size: "
                  "MODEL-prune-MEASURE.csv and .svg")
      ->check(CLI::IsMember(prune_names()));
  command.add_flag(
      "--error-curve", medial.error_curve,
      "Also write the error of the axis simplified to fewer and fewer balls: MODEL-error-curve.csv and .svg");
  CLI::Option* envelope = command.add_option(
      "--envelope", medial.envelope,
      "Write the envelope of the axis, or of the simplified axis of --vertices or --error, to this .obj file");
  command
      .add_option("--envelope-cell", medial.envelope_cell,
                  "Size of the grid cells of --envelope, in percent of the diagonal. Thinner parts may be lost; "
                  "halving it takes four times as long")
      ->check(NumberValidator(CLI::Range(0.01, 50.0)))
      ->needs(envelope)
      ->capture_default_str();
}

void add_angle(CLI::App& command, const std::string& option, double& radians, const std::string& help, double most) {
  command
      .add_option_function<double>(
          option, [&radians](double degrees) { radians = degrees * std::numbers::pi / 180; }, help)
      ->check(NumberValidator(CLI::Range(most < 180 ? 0.01 : 0.0, most)));
}

void add_thickness_options(CLI::App& command, ThicknessCommand& thickness) {
  command
      .add_option_function<std::string>(
          "--definition",
          [&thickness](const std::string& name) {
            thickness.options.definition = name == "ray" ? ThicknessDefinition::ray : ThicknessDefinition::ball;
          },
          "What thickness is: the diameter of the largest ball in the solid that touches the place (ball, default) or "
          "the "
          "length of a ray inward (ray)")
      ->check(CLI::IsMember({"ball", "ray"}));
  add_angle(command, "--facing", thickness.options.facing,
            "Smallest angle in degrees at which the centre of the ball sees its contacts on two facing sides [120]. "
            "At places with a smaller angle, the thickness is not defined",
            180);
  add_angle(command, "--smooth", thickness.options.smooth,
            "Largest angle in degrees by which a surface turns at an edge that counts as smooth [40]. Balls shrink to "
            "zero at sharper convex edges",
            90);
  command
      .add_option("--samples", thickness.options.samples,
                  "Approximate number of triangles into which the surface is divided. Thickness is measured at their "
                  "centres and corners")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  const auto add_limit = [&](const char* option, std::optional<double>& limit, const char* help) {
    return command.add_option(option, limit, help)->check(NumberValidator(CLI::Range(0.0, kMaxCoordinate)));
  };
  CLI::Option* below = add_limit(
      "--below", thickness.below,
      "Report the area that is thinner than this, in mesh units, with the regions and their smallest thickness");
  add_limit("--fail-below", thickness.fail_below, "The same as --below, and exit with 4 if any place is thinner")
      ->excludes(below);
  command.add_option("--bins", thickness.bins, "Number of bins of the histogram")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
}

}  // namespace

void add_sample(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("sample", "Sample a mesh with evenly spaced surface points");
  SampleCommand& sample = request.sample;
  add_mesh(command, request, sample.mesh, sample.input);
  command
      .add_option("-o,--output", sample.folder,
                  "Folder that receives the points, or a file for them alone (.xyz or .vtp)")
      ->required();
  add_sampling_options(command, sample);
  add_threads(command, request);
  command.add_flag("!--no-views", sample.views, "Do not write files for ParaView");
  add_report(command, sample.report);
  add_force(command, sample.output);
  add_output_flags(command, sample.output);
  command.footer(
      "Examples:\n  orchard sample data/lamp.obj -o out/lamp\n  orchard sample data/lamp.obj -o out/lamp --samples "
      "20000\n  orchard sample data/faucet.obj -o out/faucet --relaxation neighbors --seed 7");
  command.callback([&request, &command] {
    request.sample.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::sample(request.sample); };
  });
}

void add_voronoi(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("voronoi", "Build the Voronoi diagram of points and measure its accuracy");
  VoronoiCommand& voronoi = request.voronoi;
  command
      .add_option("input", voronoi.input,
                  mesh_help("Points (.xyz, or .ply or .obj without faces), or a mesh to sample"))
      ->required();
  request.meshes.push_back({&voronoi.input, &voronoi.sampling.input});
  add_mesh_input(command, voronoi.sampling.input);
  auto* algorithm =
      command
          .add_option_function<std::string>(
              "--algorithm",
              [&voronoi](const std::string& name) { voronoi.algorithm = *orchard::voronoi_algorithm_named(name); },
              "Algorithm (default: highest-first). exact uses exact arithmetic throughout; bowyer and inagaki are the "
              "dissertation's, for comparison")
          ->check(CLI::IsMember({"bowyer", "inagaki", "highest-first", "exact"}));
  command
      .add_flag("--compare", voronoi.compare,
                "Run all four algorithms on the same points and compare their accuracy and time")
      ->excludes(algorithm);
  auto* folder = command.add_option("-o,--output", voronoi.folder,
                                    "Folder that receives the cells for ParaView and the points of a mesh");
  add_list(command, "--cells", voronoi.cells, "Write only the cells of these points, counted from 0, such as 3,14,15")
      ->needs(folder);
  command
      .add_option("--box", voronoi.box,
                  "Clip the cells to this box: x y z of its lower corner, then of its upper corner")
      ->expected(6)
      ->needs(folder);
  const auto others = static_cast<std::ptrdiff_t>(command.get_options().size());
  add_sampling_options(command, voronoi.sampling);
  const auto all = std::as_const(command).get_options();
  const std::vector<const CLI::Option*> sampling(all.begin() + others, all.end());
  add_threads(command, request);
  add_report(command, voronoi.report)->needs(folder);
  add_force(command, voronoi.output)->needs(folder);
  add_output_flags(command, voronoi.output);
  command.footer(
      "Examples:\n  orchard voronoi data/faucet.obj --compare\n  orchard voronoi data/lamp.obj --samples 2000 -o "
      "out/lamp --cells 3,14,15\n  orchard voronoi points.xyz --algorithm exact");
  command.callback([&request, &command, sampling] {
    request.voronoi.output.run = invocation_of(command, request.typed);
    request.voronoi.sampling_given = given_of(sampling);
    request.run = [&request] { orchard::apps::voronoi(request.voronoi); };
  });
}

// Either the word auto or a percentage.
CLI::Validator noise_validator() {
  const NumberValidator level(CLI::Range(1e-4, 100 * kMaxNoise));
  return {[level](std::string& text) { return text == "auto" ? std::string() : level(text); }, "auto or a percentage"};
}

void add_noise(CLI::App& command, MeshOptions& reading) {
  CLI::Option* noise = command.add_option(
      "--noise", reading.noise,
      fmt::format(
          "Smooth away the noise of a scan before anything else. The value is its standard deviation in percent "
          "of the diagonal (0.0001 to {:g}), or auto to estimate it. Unless they are given, --border-loss and "
          "--feature-loss grow with it",
          100 * kMaxNoise));
  noise->check(noise_validator());
  for (const char* other : {"--strict", "--wrap", "--features", "--points", "--diagram", "--axis"})
    noise->excludes(command.get_option(other));
}

void add_medial(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("medial", "Build, measure or simplify the medial axis of a mesh");
  MedialCommand& medial = request.medial;
  add_mesh(command, request, medial.mesh, medial.reading.input);
  command
      .add_option("-o,--output", medial.folder,
                  "Folder that receives the axis and the reports, or a file for the axis alone (.ma, .ply, .obj, .vtp, "
                  ".npz or .graphml)")
      ->required();
  medial.reading.unite = true;  // an axis is that of the solid, not of what lies within
  add_mesh_options(command, medial.reading);
  add_side(command, medial);
  add_features(command, medial);
  command.add_flag("--report", medial.report,
                   "Measure the quality of the axis (docs/reference/medial-measures.md) and write an .html page with "
                   "tables, plots and a picture");
  command.add_option("--beside", medial.beside, "Measure this axis of another system beside this one. May be repeated")
      ->allow_extra_args(false);
  CLI::Option* picture = command.add_flag("--picture", medial.picture,
                                          "With --report or --axis: draw the places where the axis is worst, numbered");
  add_up(command, medial.up)->needs(picture);
  command
      .add_option(
          "--quality-samples", medial.quality_samples,
          "Number of surface points at which to measure. Lower values are faster and miss more of the largest errors")
      ->check(CLI::Range(100, 10'000'000))
      ->capture_default_str();
  add_other_axis(command, medial);
  add_axis_source(command, medial.source);
  add_noise(command, medial.reading);
  add_few_balls(command, medial);
  add_sweep(command, medial);
  add_tuning(command, medial.tuning, false);
  command
      .add_flag(
          "--raw", [&medial](std::int64_t) { medial.tuning.refine = false; },
          "Keep the axis of the Voronoi diagram, as in the dissertation. The same as --refine no")
      ->excludes(command.get_option("--refine"));
  add_threads(command, request);
  command.add_flag("!--no-views", medial.views, "Do not write files for ParaView");
  command
      .add_option(
          "--light", medial.light_balls,
          "Most balls of MODEL-medial-light.vtp, which stands for an axis with more balls where they are drawn as "
          "spheres: the largest ball of each region. 0 writes no such file")
      ->capture_default_str()
      ->check(CLI::Range(0, 100'000'000));
  add_accept(command, medial.accept);
  add_force(command, medial.output);
  add_output_flags(command, medial.output);
  command.footer(
      "Examples:\n  orchard medial data/lamp.obj -o out/lamp --report\n"
      "  orchard medial data/lamp.obj -o out/lamp --report --beside other.ma --beside older.ma --picture\n"
      "  orchard medial data/lamp.obj -o out/lamp --axis other.ma\n"
      "  orchard medial data/lamp.obj -o out/lamp --vertices 200 --envelope out/lamp/envelope.obj\n"
      "  orchard medial data/lamp.obj -o out/lamp --sweep samples=1000,4000 --sweep 'prune angle=0,20'\n"
      "  orchard medial data/lamp.obj -o out/lamp --sweep vertices=50,100,200 --keep --quality-samples 5000");
  command.callback([&request, &command] {
    request.medial.output.run = invocation_of(command, request.typed);
    request.medial.given = given_of(command);
    std::vector<std::string> kinds{"ply", "obj", "vtp", "npz"};
    if (!request.medial.axis.empty()) kinds.insert(kinds.end(), {"ma", "graphml"});
    export_single_file(request.medial.folder, kinds, request.medial.exports);
    expand_sweep(command, request.medial);
    request.run = [&request] { request.exit_code = orchard::apps::medial(request.medial); };
  });
}

void add_leaderboard(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("leaderboard", "Measure the medial axes of several systems in a folder beside orchard's own");
  LeaderboardCommand& leaderboard = request.leaderboard;
  command
      .add_option("folder", leaderboard.input,
                  "Folder of meshes. It has the axes, MODEL-SYSTEM-N.ma (.obj, .ply, ..), too, or a subfolder results "
                  "with them")
      ->required();
  command
      .add_option("-o,--output", leaderboard.folder,
                  "Folder that receives the table, and the state from which a later run continues")
      ->required();
  add_list(
      command, "--builders", leaderboard.builders,
      "Which axes of orchard to measure with the same numbers of balls as the others: refined, raw (default: both)",
      {"refined", "raw"});
  add_list(command, "--vertices", leaderboard.vertices, "Numbers of balls to build in addition to those of the axes",
           1);
  command.add_flag("--connect", leaderboard.connect,
                   "Connect balls without edges and triangles by the cells of their power diagram in the solid");
  command
      .add_option("--quality-samples", leaderboard.quality_samples,
                  "Number of surface points at which each axis is measured")
      ->capture_default_str()
      ->check(CLI::Range(100, 10'000'000));
  command.add_option("--samples", leaderboard.samples, "Number of surface points from which orchard's axes are built")
      ->capture_default_str()
      ->check(CLI::Range(10, 10'000'000));
  command.add_option("--seed", leaderboard.seed, "Seed of all random choices")->capture_default_str();
  add_report(command, leaderboard.report);
  add_force(command, leaderboard.output);
  add_output_flags(command, leaderboard.output);
  command.footer(
      "Examples:\n  orchard leaderboard results -o out/leaderboard\n  orchard leaderboard results -o out/leaderboard "
      "--vertices 50,100,300\n  orchard leaderboard results -o out/leaderboard --builders refined --connect");
  command.callback([&request, &command] {
    request.leaderboard.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::leaderboard(request.leaderboard); };
  });
}

void add_thickness(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("thickness", "Measure the local thickness of a solid and report where it is too thin");
  ThicknessCommand& thickness = request.thickness;
  add_mesh(command, request, thickness.mesh, thickness.reading.input);
  command
      .add_option(
          "-o,--output", thickness.folder,
          "Folder that receives the mesh with its thickness, the histogram and the report, or a file for one of "
          "them (.ply, .vtp, .csv or .svg)")
      ->required();
  add_thickness_options(command, thickness);
  thickness.reading.unite = true;
  add_mesh_options(command, thickness.reading);
  add_threads(command, request);
  add_report(command, thickness.report);
  command.add_flag("!--no-views", thickness.views, "Do not write files for ParaView");
  add_force(command, thickness.output);
  add_output_flags(command, thickness.output);
  command.footer(
      "Examples:\n  orchard thickness data/lamp.obj -o out/lamp --below 0.1\n"
      "  orchard thickness data/lamp.obj -o out/lamp --fail-below 0.01 --unit mm\n"
      "  orchard thickness data/ship.obj -o out/ship --definition ray --samples 100000");
  command.callback([&request, &command] {
    request.thickness.output.run = invocation_of(command, request.typed);
    request.run = [&request] { request.exit_code = orchard::apps::thickness(request.thickness); };
  });
}

}  // namespace orchard::apps
