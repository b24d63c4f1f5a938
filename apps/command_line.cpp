// All commands' options beside each other, so that the same option reads the same everywhere: hence its length.
#include "command_line.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <numbers>
#include <optional>
#include <utility>

#include "a_number.h"
#include "axis_export.h"
#include "command_list.h"
#include "list_option.h"
#include "orchard/geometry/tolerance.h"
#include "set_options.h"
#include "tree_options.h"

namespace orchard::apps {
namespace {

// The options on the command line, by their long names.
std::vector<std::string> given_of(const std::vector<const CLI::Option*>& options) {
  std::vector<std::string> given;
  for (const CLI::Option* option : options)
    if (option->count() > 0 && !option->get_lnames().empty()) given.push_back(option->get_lnames().front());
  return given;
}

std::vector<std::string> given_of(const CLI::App& command) { return given_of(command.get_options()); }

void add_output_flags(CLI::App& command, Output& output) {
  command.add_flag("--quiet", output.quiet, "Print nothing but errors");
  command.add_flag("--json", output.json, "Print a JSON report instead of a table, --quiet or not");
}

void add_accept(CLI::App& command, bool& accept) {
  command.add_flag("--accept", accept,
                   "Exit with 0 although the result lacks something that was promised: it is said all the same");
}

CLI::Option* add_join(CLI::App& command, std::optional<double>& join) {
  return command
      .add_option(
          "--join", join,
          fmt::format("Corners of open edges up to this far apart are one, in bounding radii; 0: none (default: {:g})",
                      tolerance::kJoin))
      ->check(ANumber(CLI::Range(0.0, kMaxJoin)));
}

CLI::Option* add_force(CLI::App& command, Output& output) {
  return command.add_flag("--force", output.force,
                          "Replace the files of another input of the same name; without it the command refuses to");
}

void add_mesh_options(CLI::App& command, MeshOptions& options) {
  auto* strict =
      command.add_flag("--strict", options.strict, "Refuse a mesh that is no closed manifold instead of repairing it");
  auto* wrap =
      command
          .add_flag("--wrap{" + kDefaultWrap + "}", options.wrap,
                    "Build on a closed skin around the mesh; =OFFSET: about how far outside, in diagonals of its box")
          ->excludes(strict);
  command
      .add_option(
          "--wrap-alpha", options.wrap_alpha,
          "Openings narrower than this stay closed, in diagonals; less follows the mesh better, and takes longer")
      ->check(ANumber(CLI::Range(1e-4, 0.5)))
      ->needs(wrap)
      ->capture_default_str();
  command
      .add_option_function<double>(
          "--fill-holes", [&options](double width) { options.fill_holes = width; },
          "Fill holes up to this width, in bounding radii, whatever their edges (default: 0.5, and of at most 100 "
          "edges)")
      ->check(ANumber(CLI::Range(0.0, 2.0)))
      ->excludes(strict)
      ->excludes(wrap);
  add_join(command, options.join)->excludes(strict)->excludes(wrap);
  command
      .add_option_function<std::string>(
          "--root-ball",
          [&options](const std::string& name) {
            options.ball = name == "ritter" ? BoundingBall::ritter : BoundingBall::minimal;
          },
          "The ball around the whole, the root of the tree: minimal (default), or ritter for that of Ritter's method")
      ->check(CLI::IsMember({"minimal", "ritter"}));
}

// Those that the command has a use for.
void add_tuning(CLI::App& command, MedialTuning& tuning, bool for_tree) {
  for (const TuningFlag& flag : tuning_flags()) {
    if (for_tree && flag.step >= TuningStep::refining) continue;
    const bool needs = for_tree && flag.name == "samples";
    const bool of_all = for_tree && flag.name == "seed";  // no axis is needed to use it
    const std::string help = of_all ? "Of all random choices: another tree, about as good" : flag.help;
    command
        .add_option_function<std::string>(
            "--" + flag.name, [&tuning, &flag](const std::string& value) { flag.set(tuning, value); },
            help + " [" + (needs ? "as method and depth need" : flag.standard) + "]")
        ->check(CLI::Validator([&flag](std::string& value) { return flag.fault(value); }, "{" + flag.range() + "}"))
        ->group(of_all     ? "Options"
                : for_tree ? "Medial axis, for --method tightened and merging"
                           : "Tuning");
  }
}

void add_axis_source(CLI::App& command, AxisSource& source) {
  command.add_option("--points", source.points, "Your own surface points: .xyz, .ply or .obj");
  command.add_option("--diagram", source.diagram,
                     "Your own Voronoi diagram of points on the mesh, a .vor file; its gaps are not repaired");
}

void add_build(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("build", "Build the sphere-tree of a triangle mesh");
  BuildCommand& build = request.build;
  command.add_option("mesh", build.mesh, "The mesh: .obj, .ply, .stl or .off")->required();
  command.add_option("-o,--output", build.folder, "Folder for the tree, the views and the report")->required();
  add_mesh_options(command, build.reading);
  add_tree_options(command, build.options);
  command
      .add_option("--time", build.seconds,
                  "tightened: the tightest tree that there is after so many seconds, at whatever effort; the octree if "
                  "there is none yet")
      ->check(ANumber(CLI::Range(0.0, 1e6)))
      ->excludes(command.get_option("--effort"));
  add_tuning(command, build.tuning, true);
  add_axis_source(command, build.source);
  command.add_option("--from-axis", build.source.axis,
                     "Build from this medial axis, a file of any system, instead of one of its own");
  command.add_option("--threads", request.threads, "Threads at most; the result does not depend on it")
      ->check(CLI::Range(1, 1024));
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

void add_spheres(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("spheres", "Make a set of spheres for a mesh, with a promise and its proof");
  SpheresCommand& spheres = request.spheres;
  command.add_option("mesh", spheres.mesh, "The mesh: .obj, .ply, .stl or .off")->required();
  command.add_option("-o,--output", spheres.folder, "Folder for the spheres, the views and the report")->required();
  add_set_options(command, spheres);
  add_mesh_options(command, spheres.reading);
  auto* exports =
      add_list(command, "--export", spheres.exports,
               "The spheres in further formats: json, csv, urdf (a link's collision geometry), yaml (cuRobo's)",
               {"json", "csv", "urdf", "yaml"});
  command.add_option("--link", spheres.link, "The link's name in urdf and yaml (default: the mesh's)")->needs(exports);
  command.add_flag("--tree", spheres.tree,
                   "Write an .orchard file of two levels over the spheres of a cover, for the run-time");
  command.add_flag("!--no-views", spheres.views, "Write no files for ParaView");
  command.add_flag("--picture", spheres.picture, "Draw the spheres");
  command.add_option("--up", spheres.up, "The mesh's axis that points up in the picture")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  command.add_option("--threads", request.threads, "Threads at most; the result does not depend on it")
      ->check(CLI::Range(1, 1024));
  add_accept(command, spheres.accept);
  add_force(command, spheres.output);
  add_output_flags(command, spheres.output);
  command.footer(
      "Examples:\n  orchard spheres data/lamp.obj -o out/lamp-spheres -n 20\n"
      "  orchard spheres data/lamp.obj -o out/lamp-inside -n 40 --fit inside --export json,csv\n"
      "  orchard spheres data/lamp.obj -o out/lamp-balanced -n 30 --fit balanced");
  command.callback([&request, &command] {
    request.spheres.output.run = invocation_of(command, request.typed);
    request.spheres.given = given_of(command);
    request.run = [&request] { request.exit_code = orchard::apps::spheres(request.spheres); };
  });
}

void add_audit(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("audit", "Prove what a set of spheres of any origin leaves open of a mesh, and measure it");
  AuditCommand& audit = request.audit;
  command
      .add_option(
          "spheres", audit.spheres,
          "The spheres, in the mesh's frame: text or .csv of x y z r, .json lists, .yml of cuRobo, .xrdf, .ply with "
          "radii, .sph, .orchard")
      ->required();
  command.add_option("mesh", audit.mesh, "The mesh: .obj, .ply, .stl or .off")->required();
  command.add_option("--link", audit.link, "The link, where a file has several");
  command
      .add_option("--buffer", audit.buffer,
                  "Audit the spheres with this much on every radius, too, in place of the file's own buffer")
      ->check(ANumber(CLI::Range(-1e15, 1e15)));
  add_join(command, audit.join);
  auto* folder = command.add_option("-o,--output", audit.folder, "Folder for the views and the report");
  auto* picture =
      command.add_flag("--picture", audit.picture, "Draw where the surface is open and where spheres stick out")
          ->needs(folder);
  command.add_option("--up", audit.up, "The mesh's axis that points up in the picture")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->needs(picture)
      ->capture_default_str();
  add_force(command, audit.output)->needs(folder);
  add_output_flags(command, audit.output);
  command.footer(
      "Exit code 3 if some of the surface is open.\n"
      "Example:\n  orchard audit out/lamp-spheres/lamp-set.txt data/lamp.obj -o out/lamp-audit");
  command.callback([&request, &command] {
    request.audit.output.run = invocation_of(command, request.typed);
    request.run = [&request] { request.exit_code = orchard::apps::audit(request.audit); };
  });
}

void add_compare(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("compare", "Tell which of several trees fits a mesh tightest, level by level");
  CompareCommand& compare = request.compare;
  command.add_option("mesh", compare.mesh, "The mesh: .obj, .ply, .stl or .off")->required();
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
      ->check(ANumber(CLI::Range(0.0, 90.0)));
  command.add_option("--crease-angle", sample.crease_degrees, "Degrees from which a curved mesh has an edge [28.6]")
      ->check(ANumber(CLI::Range(0.0, 180.0)));
  command.add_option("--seed", sample.seed, "Seed of the random points")->capture_default_str();
  add_join(command, sample.join);
}

void add_sample(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("sample", "Spread points evenly over a mesh");
  SampleCommand& sample = request.sample;
  command.add_option("mesh", sample.mesh, "The mesh: .obj, .ply, .stl or .off")->required();
  command.add_option("-o,--output", sample.folder, "Folder for the points")->required();
  add_sampling_options(command, sample);
  command.add_option("--threads", request.threads, "Threads at most; the result does not depend on it")
      ->check(CLI::Range(1, 1024));
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
  command.add_option("--threads", request.threads, "Threads at most; the result does not depend on it")
      ->check(CLI::Range(1, 1024));
  add_force(command, voronoi.output)->needs(folder);
  add_output_flags(command, voronoi.output);
  command.footer("Example:\n  orchard voronoi data/faucet.obj --compare -o out/faucet");
  command.callback([&request, &command, sampling] {
    request.voronoi.output.run = invocation_of(command, request.typed);
    request.voronoi.sampling_given = given_of(sampling);
    request.run = [&request] { orchard::apps::voronoi(request.voronoi); };
  });
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
      ->check(ANumber(CLI::Range(1.1, 1000.0)))
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
      ->check(ANumber(CLI::Range(1e-4, 100.0)))
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
      ->check(ANumber(CLI::Range(0.01, 50.0)))
      ->needs(envelope)
      ->capture_default_str();
}

void add_medial(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("medial", "Build the medial axis of a mesh, or judge one");
  MedialCommand& medial = request.medial;
  command.add_option("mesh", medial.mesh, "The mesh: .obj, .ply, .stl or .off")->required();
  command.add_option("-o,--output", medial.folder, "Folder for the axis and the reports")->required();
  add_mesh_options(command, medial.reading);
  add_side(command, medial);
  add_features(command, medial);
  command.add_flag("--report", medial.report, "Measure the quality of what was built (docs/medial-quality.md)");
  command
      .add_option("--beside", medial.beside,
                  "The axis of any system to measure with the same instrument, beside this axis; again for another one")
      ->allow_extra_args(false);
  CLI::Option* picture = command.add_flag("--picture", medial.picture,
                                          "With --report or --axis: draw where the axis is worst, places numbered");
  command.add_option("--up", medial.up, "The mesh's axis that points up in the picture")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->needs(picture)
      ->capture_default_str();
  command
      .add_option("--quality-samples", medial.quality_samples,
                  "Surface points to measure at: fewer are faster and miss more of the largest errors")
      ->check(CLI::Range(100, 10'000'000))
      ->capture_default_str();
  CLI::Option* axis = command.add_option(
      "--axis", medial.axis,
      "Build nothing; measure this axis of any system: .ma, .obj, .ply, .off, .sph, .swc or text (docs/FORMATS.md)");
  command
      .add_flag("--connect", medial.connect,
                "With --axis: connect balls without cells by their power diagram within the solid")
      ->needs(axis);
  add_list(command, "--export", medial.exports, "With --axis: write it in these formats as well: AXIS-converted.ma, ..",
           axis_export_kinds())
      ->needs(axis);
  add_axis_source(command, medial.source);
  add_few_balls(command, medial);
  command
      .add_option("--sweep", medial.sweep, "NAME=A,B,..: run with each value of a tuning flag; again for another one")
      ->allow_extra_args(false);
  command
      .add_option(
          "--best", medial.best,
          "Of a --sweep: the measure by which its rows are printed, the best first; right topologies before wrong")
      ->capture_default_str();
  add_sweep_tree(command, medial.tree);
  add_tuning(command, medial.tuning, false);
  command
      .add_flag(
          "--raw", [&medial](std::int64_t) { medial.tuning.refine = false; },
          "The axis as the Voronoi diagram has it, the dissertation's: the same as --refine no")
      ->excludes(command.get_option("--refine"));
  command.add_option("--threads", request.threads, "Threads at most; the result does not depend on it")
      ->check(CLI::Range(1, 1024));
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

void add_inspect(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("inspect", "Say what a mesh or tree file holds and what is wrong with it");
  InspectCommand& inspect = request.inspect;
  command.add_option("file", inspect.file, "A mesh (.obj, .ply, .stl, .off) or a tree (.orchard, .sph)")->required();
  add_join(command, inspect.join);
  command.add_flag("--full", inspect.full, "Look for self-intersections in a mesh of more than 500,000 triangles too");
  add_output_flags(command, inspect.output);
  command.footer("Example:\n  orchard inspect data/lamp.obj");
  command.callback([&request, &command] {
    request.inspect.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::inspect(request.inspect); };
  });
}

void add_angle(CLI::App& command, const std::string& option, double& radians, const std::string& help, double most) {
  command
      .add_option_function<double>(
          option, [&radians](double degrees) { radians = degrees * std::numbers::pi / 180; }, help)
      ->check(ANumber(CLI::Range(most < 180 ? 0.01 : 0.0, most)));
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
    return command.add_option(option, limit, help)->check(ANumber(CLI::Range(0.0, kMaxCoordinate)));
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

void add_thickness(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("thickness", "Measure how thick a solid is everywhere, and say where it is too thin");
  ThicknessCommand& thickness = request.thickness;
  command.add_option("mesh", thickness.mesh, "The mesh: .obj, .ply, .stl or .off")->required();
  command.add_option("-o,--output", thickness.folder, "Folder for the mesh with its thickness, histogram and report")
      ->required();
  add_thickness_options(command, thickness);
  add_mesh_options(command, thickness.reading);
  command.add_option("--threads", request.threads, "Threads at most; the result does not depend on it")
      ->check(CLI::Range(1, 1024));
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

void add_figure(CLI::App& command, ViewCommand& view) {
  CLI::Option* color = command.add_option(
      "--color", view.color,
      "Colour by an array: radius, structure of axes; radius, error, inaccuracy, level of trees; any of .vtp files");
  command.add_option("--range", view.range, "A,B: of these colours (default: of all values)")->needs(color);
  CLI::Option* place = command.add_option("--look-at", view.look_at, "X,Y,Z: the middle of the picture");
  command.add_option("--width", view.width, "Of what is seen around it, in mesh units (default: everything)")
      ->needs(place)
      ->check(CLI::PositiveNumber);
  command.add_option("--clip", view.clip, "A,B,C,D: cut away what has A x + B y + C z > D");
  command.add_flag("--edges", view.edges,
                   "Lines at borders (dark) and seams (orange) of axes, and at feature edges of .vtp files");
  command.add_flag("--balls", view.balls, "The balls of axes, not their sheets");
  command
      .add_option("--layout", view.layout, "Files over each other, or each beside the others with the meshes around it")
      ->capture_default_str()
      ->check(CLI::IsMember({"over", "beside"}));
  command.add_flag("!--no-captions", view.captions, "No words below the pictures");
  command.add_flag("--transparent", view.transparent, "No white ground");
  command.add_option("--turn", view.turn, "So many pictures from all around: PICTURE-001.png ..")
      ->check(CLI::Range(2, 3600));
}

void add_view(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("view", "Draw files, one in the other, or look at them in a window");
  ViewCommand& view = request.view;
  command
      .add_option(
          "files", view.files,
          "Trees (.orchard, .sph), medial axes (.ma), Voronoi diagrams (.vor), meshes (.obj, .ply, .stl, .off), "
          "points (.xyz)")
      ->required();
  command.add_option("-o,--output", view.picture, "The picture, a .png file; with --window, where the key s saves to");
  add_list(command, "--level", view.levels,
           "Level of the trees, 0 for the root; several, such as 1,2,3, make a panel each (default: the deepest)", 0,
           1'000'000);
  command.add_option("--camera", view.camera,
                     "Where the eye is: degrees from the front to the right, and upward (default: 34,23)");
  command.add_option("--up", view.up, "The axis that points up")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  command.add_option("--size", view.size, "WIDTHxHEIGHT in pixels (default: as the model needs; a window 1000x800)");
  command.add_option("--opacity", view.opacity, "Of meshes, where there is something else to see: 0 to 1")
      ->check(ANumber(CLI::Range(0.0, 1.0)))
      ->capture_default_str();
  add_figure(command, view);
  command.add_flag("--window", view.window,
                   "Open a window: up, down and digits choose the level, o and O the opacity of meshes; a click on a "
                   "sphere prints its record, s saves what is seen, r shows all again, q closes");
  command.add_flag("--quiet", view.quiet, "Print nothing but errors");
  command.footer(
      "Examples:\n  orchard view out/lamp/lamp.orchard data/lamp.obj -o out/lamp/view.png --level 1,2,3\n"
      "  orchard view out/lamp/lamp.orchard --window");
  command.callback([&request, &command] {
    request.view.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::view(request.view); };
  });
}

void add_completion(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("completion", "Print a script that completes commands in a shell");
  command.add_option("shell", request.shell, "bash or zsh")->required()->check(CLI::IsMember({"bash", "zsh"}));
  command.footer(
      "Examples:\n  orchard completion bash > ~/.local/share/bash-completion/completions/orchard\n"
      "  orchard completion zsh > /usr/local/share/zsh/site-functions/_orchard");
  command.callback([&app, &request] {
    request.run = [&app, &request] {
      fmt::print("{}", request.shell == "bash" ? bash_completion(app) : zsh_completion(app));
    };
  });
}

// What packages and pages are made with; --help does not list it.
void add_reference(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("reference", "Print all commands and options")->group("");
  command.add_option("format", request.format, "markdown or man")
      ->required()
      ->check(CLI::IsMember({"markdown", "man"}));
  command.callback([&app, &request] {
    request.run = [&app, &request] {
      fmt::print("{}", request.format == "man" ? manual_page(app, ORCHARD_VERSION) : markdown_reference(app));
    };
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

// An empty word, as a script's unset variable leaves one, is never what anybody means, nor the same as no option at
// all.
void refuse_empty_values(CLI::App& app) {
  const CLI::Validator named([](std::string& value) { return value.empty() ? "the value is empty" : ""; }, "");
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    for (CLI::Option* option : command->get_options())
      if (option->get_expected_min() > 0) option->check(named);
}

}  // namespace

void add_commands(CLI::App& app, Request& request) {
  add_build(app, request);
  add_collide(app, request);
  add_verify(app, request);
  add_inspect(app, request);
  add_sample(app, request);
  add_compare(app, request);
  add_spheres(app, request);
  add_audit(app, request);
  add_voronoi(app, request);
  add_medial(app, request);
  add_leaderboard(app, request);
  add_thickness(app, request);
  add_view(app, request);
  add_completion(app, request);
  add_reference(app, request);
  add_profile(app, request);
  add_simulate(app, request);
  refuse_empty_values(app);
}

}  // namespace orchard::apps
