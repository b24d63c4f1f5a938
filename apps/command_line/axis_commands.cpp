// Options of the commands that lead to medial axes, judge and use them.
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
namespace {

Relaxation relaxation_named(const std::string& name) {
  return name == "clusters"    ? Relaxation::clusters
         : name == "neighbors" ? Relaxation::neighbors
                               : Relaxation::automatic;
}

void add_sampling_options(CLI::App& command, SampleCommand& sample) {
  command.add_option("--samples", sample.samples, "Points in all")
      ->check(CLI::Range(20, 10'000'000))
      ->capture_default_str();
  command.add_option("--edge-samples", sample.edge_samples, "Of them on edges (default: a fifth)")
      ->check(CLI::Range(0, 10'000'000));
  command.add_option("--iterations", sample.iterations, "Of relaxation")
      ->check(CLI::Range(0, 10'000))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--relaxation", [&sample](const std::string& name) { sample.relaxation = relaxation_named(name); },
          "Points keep apart within coplanar clusters, from neighbors across faces, or as fits the mesh (automatic)")
      ->check(CLI::IsMember({"automatic", "clusters", "neighbors"}));
  command
      .add_option("--cluster-angle", sample.cluster_degrees, "Degrees that a cluster may turn; more makes curved ones")
      ->check(NumberValidator(CLI::Range(0.0, 90.0)));
  command.add_option("--crease-angle", sample.crease_degrees, "Degrees from which a curved mesh has an edge [28.6]")
      ->check(NumberValidator(CLI::Range(0.0, 180.0)));
  command.add_option("--seed", sample.seed, "Seed of the random points")->capture_default_str();
  add_join(command, sample.join);
}

void add_sweep_tree(CLI::App& command, std::optional<SphereTreeOptions>& tree) {
  const auto wanted = [&tree]() -> SphereTreeOptions& {
    if (!tree) tree.emplace();
    return *tree;
  };
  command
      .add_option_function<std::string>(
          "--tree",
          [wanted](const std::string& method) {
            wanted().method = method == "merging" ? TreeMethod::merging : TreeMethod::tightened;
          },
          "With --sweep: build this tree from each axis too, and say how tight it is: tightened or merging")
      ->check(CLI::IsMember({"tightened", "merging"}));
  command
      .add_option_function<Index>(
          "--tree-depth", [wanted](Index depth) { wanted().depth = depth; }, "Levels of that tree below the root [3]")
      ->check(CLI::Range(1, 10));
}

void add_sweep(CLI::App& command, MedialCommand& medial) {
  command
      .add_option("--sweep", medial.sweep, "NAME=A,B,..: run with each value of a tuning flag; again for another one")
      ->allow_extra_args(false);
  command
      .add_option(
          "--best", medial.best,
          "Of a --sweep: the measure by which its rows are printed, the best first; right topologies before wrong")
      ->capture_default_str();
  add_sweep_tree(command, medial.tree);
}

void add_other_axis(CLI::App& command, MedialCommand& medial) {
  CLI::Option* axis = command.add_option("--axis", medial.axis,
                                         "Build nothing; measure this axis of any system: .ma, .obj, .ply, .off, .sph, "
                                         ".swc or text (docs/reference/formats.md)");
  command
      .add_flag("--connect", medial.connect,
                "With --axis: connect balls without cells by their power diagram within the solid")
      ->needs(axis);
  add_list(command, "--export", medial.exports,
           "Write the axis in these formats as well: MODEL-axis.npz, ..; with --axis AXIS-converted.npz, ..",
           axis_export_kinds());
}

void add_features(CLI::App& command, MedialCommand& medial) {
  command.add_option("--features", medial.features,
                     "Your own feature edges, which sheets reach to: lines of an .obj file along edges of the mesh");
}

void add_side(CLI::App& command, MedialCommand& medial) {
  CLI::Option* side = command
                          .add_option_function<std::string>(
                              "--side", [&medial](const std::string& name) { medial.outside = name == "outside"; },
                              "Of which space: inside the solid, or outside, within a sphere around it [inside]")
                          ->check(CLI::IsMember({"inside", "outside"}));
  command.add_option("--outside-radius", medial.outside_radius, "Of that sphere, in bounding radii")
      ->check(NumberValidator(CLI::Range(1.1, 1000.0)))
      ->needs(side)
      ->capture_default_str();
}

void add_few_balls(CLI::App& command, MedialCommand& medial) {
  CLI::Option* vertices =
      command
          .add_option("--vertices", medial.few_vertices,
                      "Write the axis in so many balls at most as well: MODEL-simplified.ma, .ply and .obj")
          ->check(CLI::Range(1, 100'000'000));
  command
      .add_option("--error", medial.few_error,
                  "The same, in as few balls as are this near: percent of the diagonal, two-sided distance between the "
                  "surface and what the balls stand for, as measured at the end")
      ->check(NumberValidator(CLI::Range(1e-4, 100.0)))
      ->excludes(vertices);
  command
      .add_option(
          "--balls", medial.few_kind,
          "What these balls may be: medial (centres in the solid, radii as far as the surface is, to the error; "
          "the volume is kept) or free, which may come nearer where they are too few")
      ->check(CLI::IsMember({"medial", "free"}))
      ->capture_default_str();
  command.add_flag("--curve", medial.curve, "Write how far off ever fewer balls are: MODEL-curve.csv and .svg");
  CLI::Option* envelope = command.add_option(
      "--envelope", medial.envelope,
      "Write the surface of what the balls stand for, those of --vertices or --error if given: an .obj");
  command
      .add_option(
          "--envelope-cell", medial.envelope_cell,
          "Edge of the cells that surface is cut from, in percent of the diagonal: what is thinner may be lost; "
          "time and size grow with the square of its inverse")
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
          "The diameter of the largest ball in the solid that touches the place, or the way of a ray inward [ball]")
      ->check(CLI::IsMember({"ball", "ray"}));
  add_angle(
      command, "--facing", thickness.options.facing,
      "Degrees from which the two ends of a diameter face each other; with less, the place has no thickness [120]",
      180);
  add_angle(command, "--smooth", thickness.options.smooth,
            "Degrees: edges that turn by less are those of a smooth surface, not edges where balls vanish [40]", 90);
  command
      .add_option("--samples", thickness.options.samples,
                  "Triangles that the surface is divided into, about; at their middles and corners it is measured")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  const auto add_limit = [&](const char* option, std::optional<double>& limit, const char* help) {
    return command.add_option(option, limit, help)->check(NumberValidator(CLI::Range(0.0, kMaxCoordinate)));
  };
  CLI::Option* below = add_limit("--below", thickness.below,
                                 "Say what area is thinner than this, in mesh units, in which places, and how thin");
  add_limit("--fail-below", thickness.fail_below, "The same, and exit with 4 if anything is")->excludes(below);
  command.add_option("--bins", thickness.bins, "Of the histogram")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command
      .add_option("--unit", thickness.unit, "The name of the mesh's unit, such as mm, for what is printed and written")
      ->check(CLI::Validator(
          [](std::string& name) {
            const bool word = !name.empty() && name.size() <= 16 && std::all_of(name.begin(), name.end(), [](char c) {
              return std::isalnum(static_cast<unsigned char>(c)) != 0;
            });
            return word ? std::string() : "expected a word of at most 16 letters and digits, such as mm";
          },
          "{a word}"));
}

}  // namespace

void add_sample(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("sample", "Spread points evenly over a mesh");
  SampleCommand& sample = request.sample;
  add_mesh(command, sample.mesh);
  command.add_option("-o,--output", sample.folder, "Folder for the points")->required();
  add_sampling_options(command, sample);
  add_threads(command, request);
  command.add_flag("!--no-views", sample.views, "Write no files for ParaView");
  add_force(command, sample.output);
  add_output_flags(command, sample.output);
  command.footer("Example:\n  orchard sample data/lamp.obj -o out/lamp --samples 20000");
  command.callback([&request, &command] {
    request.sample.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::sample(request.sample); };
  });
}

void add_voronoi(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("voronoi", "Build the Voronoi diagram of points and say how good it is");
  VoronoiCommand& voronoi = request.voronoi;
  command
      .add_option("input", voronoi.input,
                  "Points (.xyz, or .ply or .obj without faces), or a mesh to sample (.obj, .ply, .stl or .off)")
      ->required();
  auto* algorithm =
      command
          .add_option_function<std::string>(
              "--algorithm",
              [&voronoi](const std::string& name) { voronoi.algorithm = *orchard::voronoi_algorithm_named(name); },
              "bowyer, inagaki, highest-first (default) or exact")
          ->check(CLI::IsMember({"bowyer", "inagaki", "highest-first", "exact"}));
  command.add_flag("--compare", voronoi.compare, "Run all four algorithms on the same points")->excludes(algorithm);
  auto* folder = command.add_option("-o,--output", voronoi.folder,
                                    "Folder for the cells, for ParaView, and for the points of a mesh");
  add_list(command, "--cells", voronoi.cells, "Write the cells of these points alone, counted from 0: 3,14,15")
      ->needs(folder);
  command.add_option("--box", voronoi.box, "Clip the cells to this box: x y z of its lower and upper corner")
      ->expected(6)
      ->needs(folder);
  const auto others = static_cast<std::ptrdiff_t>(command.get_options().size());
  add_sampling_options(command, voronoi.sampling);
  const auto all = std::as_const(command).get_options();
  const std::vector<const CLI::Option*> sampling(all.begin() + others, all.end());
  add_threads(command, request);
  add_force(command, voronoi.output)->needs(folder);
  add_output_flags(command, voronoi.output);
  command.footer("Example:\n  orchard voronoi data/faucet.obj --compare -o out/faucet");
  command.callback([&request, &command, sampling] {
    request.voronoi.output.run = invocation_of(command, request.typed);
    request.voronoi.sampling_given = given_of(sampling);
    request.run = [&request] { orchard::apps::voronoi(request.voronoi); };
  });
}

void add_medial(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("medial", "Build the medial axis of a mesh, or judge one");
  MedialCommand& medial = request.medial;
  add_mesh(command, medial.mesh);
  command.add_option("-o,--output", medial.folder, "Folder for the axis and the reports")->required();
  add_mesh_options(command, medial.reading);
  add_side(command, medial);
  add_features(command, medial);
  command.add_flag("--report", medial.report,
                   "Measure the quality of what was built (docs/reference/medial-measures.md)");
  command
      .add_option("--beside", medial.beside,
                  "The axis of any system to measure with the same instrument, beside this axis; again for another one")
      ->allow_extra_args(false);
  CLI::Option* picture = command.add_flag("--picture", medial.picture,
                                          "With --report or --axis: draw where the axis is worst, places numbered");
  add_up(command, medial.up)->needs(picture);
  command
      .add_option("--quality-samples", medial.quality_samples,
                  "Surface points to measure at: fewer are faster and miss more of the largest errors")
      ->check(CLI::Range(100, 10'000'000))
      ->capture_default_str();
  add_other_axis(command, medial);
  add_axis_source(command, medial.source);
  add_few_balls(command, medial);
  add_sweep(command, medial);
  add_tuning(command, medial.tuning, false);
  command
      .add_flag(
          "--raw", [&medial](std::int64_t) { medial.tuning.refine = false; },
          "The axis as the Voronoi diagram has it, the dissertation's: the same as --refine no")
      ->excludes(command.get_option("--refine"));
  add_threads(command, request);
  command.add_flag("!--no-views", medial.views, "Write no files for ParaView");
  add_accept(command, medial.accept);
  add_force(command, medial.output);
  add_output_flags(command, medial.output);
  command.footer(
      "Examples:\n  orchard medial data/lamp.obj -o out/lamp --report\n"
      "  orchard medial data/lamp.obj -o out/lamp --report --beside other.ma --beside older.ma --picture\n"
      "  orchard medial data/lamp.obj -o out/lamp --axis other.ma\n"
      "  orchard medial data/lamp.obj -o out/lamp --vertices 200 --envelope out/lamp/envelope.obj\n"
      "  orchard medial data/lamp.obj -o out/lamp --sweep samples=1000,4000,16000 --sweep prune=0,20,40");
  command.callback([&request, &command] {
    request.medial.output.run = invocation_of(command, request.typed);
    request.medial.given = given_of(command);
    request.run = [&request] { request.exit_code = orchard::apps::medial(request.medial); };
  });
}

void add_leaderboard(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand(
      "leaderboard", "Measure the medial axes of all systems in a folder, and orchard's beside them");
  LeaderboardCommand& leaderboard = request.leaderboard;
  command
      .add_option("folder", leaderboard.input,
                  "Meshes, and axes MODEL-SYSTEM-N.ma (.obj, .ply, ..) beside them or in its folder results")
      ->required();
  command.add_option("-o,--output", leaderboard.folder, "Folder for the table, and for what a later run need not redo")
      ->required();
  add_list(command, "--builders", leaderboard.builders,
           "Of orchard, in as few balls: refined axes, raw ones (default both)", {"refined", "raw"});
  add_list(command, "--vertices", leaderboard.vertices, "Numbers of balls to build besides those of the axes", 1);
  command.add_flag("--connect", leaderboard.connect,
                   "Connect balls without cells by their power diagram within the solid");
  command.add_option("--quality-samples", leaderboard.quality_samples, "Surface points that each axis is measured at")
      ->capture_default_str()
      ->check(CLI::Range(100, 10'000'000));
  command.add_option("--samples", leaderboard.samples, "Surface points that orchard's axes are built from")
      ->capture_default_str()
      ->check(CLI::Range(10, 10'000'000));
  command.add_option("--seed", leaderboard.seed, "Of all random choices")->capture_default_str();
  add_force(command, leaderboard.output);
  add_output_flags(command, leaderboard.output);
  command.footer("Example:\n  orchard leaderboard results -o out/leaderboard --vertices 50,100,300");
  command.callback([&request, &command] {
    request.leaderboard.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::leaderboard(request.leaderboard); };
  });
}

void add_thickness(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("thickness", "Measure how thick a solid is everywhere, and say where it is too thin");
  ThicknessCommand& thickness = request.thickness;
  add_mesh(command, thickness.mesh);
  command.add_option("-o,--output", thickness.folder, "Folder for the mesh with its thickness, histogram and report")
      ->required();
  add_thickness_options(command, thickness);
  add_mesh_options(command, thickness.reading);
  add_threads(command, request);
  command.add_flag("!--no-views", thickness.views, "Write no files for ParaView");
  add_force(command, thickness.output);
  add_output_flags(command, thickness.output);
  command.footer(
      "Examples:\n  orchard thickness data/lamp.obj -o out/lamp --below 0.1\n"
      "  orchard thickness data/lamp.obj -o out/lamp --fail-below 0.01 --unit mm");
  command.callback([&request, &command] {
    request.thickness.output.run = invocation_of(command, request.typed);
    request.run = [&request] { request.exit_code = orchard::apps::thickness(request.thickness); };
  });
}

}  // namespace orchard::apps
