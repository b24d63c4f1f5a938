#include <fmt/core.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "command_line/unused_options.h"
#include "input/input_file.h"
#include "input/load_solid.h"
#include "input/reading_report.h"
#include "input/standard_input.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/tree_io.h"
#include "output/outputs.h"
#include "output/picture.h"
#include "output/promises.h"
#include "output/report.h"
#include "output/sphere_arrays.h"
#include "output/sphere_lists.h"
#include "report/report_page.h"
#include "trees/build_cost.h"
#include "trees/build_doubts.h"
#include "trees/build_plot.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/render.h"
#include "orchard/viz/vtk_writer.h"
#endif

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

std::string_view as_text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Every name that the command may write to.
std::vector<std::string> names_of(const BuildCommand& command) {
  std::vector<std::string> endings{".orchard",    ".sph",           "-levels.svg", "-build.vtm",        "-build.pvd",
                                   "-build.pvsm", "-build-view.py", ".png",        "-build-report.html"};
  for (const std::string& format : command.exports)
    endings.push_back(format == "urdf"  ? ".urdf"
                      : format == "npz" ? "-nodes.npz"
                      : format == "csv" ? "-nodes.csv"
                                        : "-spheres.json");
  endings.emplace_back(command.reading.wrap.empty() ? kRepairedEnding : kWrapEnding);
  for (const char* view : {"mesh", "points", "medial-vertices", "medial-edges", "medial-faces", "medial-contacts"})
    endings.push_back("-build-" + std::string(view) + ".vtp");
  for (Index level = 0; level <= levels_of(command.tree); ++level)
    endings.push_back("-build-level-" + std::to_string(level) + ".vtp");
  std::vector<std::string> names;
  names.reserve(endings.size());
  for (const std::string& ending : endings) names.push_back(named(command.mesh, ending));
  return names;
}

bool is_given(const BuildCommand& command, const std::string& option) {
  return std::find(command.given.begin(), command.given.end(), option) != command.given.end();
}

bool draws_axis(const BuildCommand& command) { return command.views || command.picture || command.page; }

// Whether some output shows the medial axis, which a tightened tree does not need.
bool shows_axis(const BuildCommand& command) {
  const auto tunes = [&](const TuningFlag& flag) {
    return flag.step != TuningStep::points && is_given(command, flag.name);
  };
  const std::vector<TuningFlag>& flags = tuning_flags();
  return draws_axis(command) || command.output.json || !command.source.diagram.empty() ||
         std::any_of(flags.begin(), flags.end(), tunes);
}

// Everything that the tree is built with.
SphereTreeOptions options_of(const BuildCommand& command) {
  MedialTuning tuning = command.tuning;
  // A tightened tree does not use the axis, so the refined axis is shown. Other trees are built from the raw one.
  tuning.refine = command.tree.method == TreeMethod::tightened && command.source.axis.empty() && draws_axis(command);
  const bool samples_by_need = command.seconds && !tuning.samples;  // the efforts need different numbers
  if (!tuning.samples) tuning.samples = samples_needed(builder_of(command.tree));
  const MedialBuildOptions medial = build_options(tuning);
  SphereTreeOptions options = tree_options(command.tree, medial.sampling.seed);
  options.medial = medial;
  options.samples_by_need = samples_by_need;
  options.axis = shows_axis(command);
  return options;
}

// Refuses what can be refused before anything is built. Returns where the files go.
Destination check(const BuildCommand& command) {
  check_input(command.mesh);
  check_options(command);
  std::vector<fs::path> inputs = command.source.files();
  for (const fs::path& file : inputs) check_input(file);
  inputs.insert(inputs.begin(), command.mesh);
  Destination destination{.folder = command.folder,
                          .report = named(command.mesh, ".json"),
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  keep_single_file(destination, std::array{named(command.mesh, ".orchard"), named(command.mesh, ".sph")});
  check_outputs(destination, names_of(command), inputs);
  return destination;
}

// For other programs: a list, whose first level says where it comes from.
std::string spheres_json(const SphereLists& lists, const Provenance& provenance) {
  nlohmann::json levels = to_json(lists);
  levels.front()["provenance"] = decisive_json(provenance);
  return levels.dump(1) + "\n";
}

void write_trees(const BuildCommand& command, const Provenance& provenance, const SphereTreeBuild& result,
                 Outputs& outputs) {
  const auto write = [&](const char* ending, std::string_view bytes, const char* what) {
    write_file(outputs.add(named(command.mesh, ending), what), bytes);
  };
  write(".orchard", as_text(runtime::serialize(result.packed)), "the sphere-tree for the run-time");
  write(".sph", to_sph(result.tree), "the sphere-tree as text");
  const SphereLists lists = levels_of(result.tree);
  for (const std::string& format : command.exports) {
    if (format == "json") write("-spheres.json", spheres_json(lists, provenance), "the spheres of each level");
    if (format == "npz") write("-nodes.npz", to_npz(tree_arrays(result.tree)), "the spheres as arrays for NumPy");
    if (format == "csv") write("-nodes.csv", to_csv(tree_arrays(result.tree)), "the spheres as a table");
    if (format == "urdf")
      write(".urdf", to_urdf(lists, command.export_level.value_or(result.tree.depth()), command.mesh.stem().string()),
            "a level's spheres as a link's collision geometry");
  }
}

// The mesh that everything else was built on, where that is not the file's.
const char* ending_of(const SolidMesh& solid) {
  return solid.wrap ? kWrapEnding : solid.changed() ? kRepairedEnding : nullptr;
}

void write_solid(const BuildCommand& command, const SolidMesh& solid, Outputs& outputs) {
  if (const char* ending = ending_of(solid))
    write_obj(outputs.add(named(command.mesh, ending), std::string(solid.wrap ? "the wrap" : "the repaired mesh") +
                                                           ", which everything else was built on"),
              solid.surface.mesh());
}

#ifdef ORCHARD_HAS_VIZ
// The picture that was drawn, if one was: its name in `outputs`.
std::string write_views(const BuildCommand& command, const Surface& surface, const SphereTreeBuild& result,
                        Outputs& outputs) {
  const PipelineValues values{.surface = &surface,
                              .sampling = result.medial ? &result.medial->sampling : nullptr,
                              .axis = result.medial ? &result.medial->axis : nullptr,
                              .tree = &result.tree,
                              .up = parse_up(command.up)};
  if (command.views) {
    const fs::path vtm = outputs.add(named(command.mesh, "-build.vtm"), "open this in ParaView: all views at once");
    write_pipeline(fs::path(vtm).replace_extension(), values);
    const fs::path state =
        outputs.add(named(command.mesh, "-build.pvsm"), "a double click shows the spheres in ParaView");
    write_paraview_state(fs::path(state).replace_extension(), values, command.folder);
    outputs.add(named(command.mesh, "-build-view.py"), "the same by paraview --script=.., or a picture by pvbatch");
  }
  if (!command.picture && !command.page) return {};
  PipelinePicture picture;
  picture.values = values;
  picture.title = command.mesh.stem().string();
  picture.up = parse_up(command.up);
  picture.progress = cancelled_by_interrupts();
  std::string name = named(command.mesh, ".png");
  if (!is_drawn(draw_pipeline(outputs.staged(name), picture))) return {};
  if (command.picture) outputs.add(name, "the pipeline in one picture");
  return name;
}
#else
std::string write_views(const BuildCommand& command, const Surface&, const SphereTreeBuild&, Outputs&) {
  if (command.picture || command.page)
    fmt::print(stderr, "orchard: no picture was made: this program was built without VTK\n");
  return {};
}
#endif

// The page, with the picture in it; a picture that was not asked for by itself is removed.
void write_page(const BuildCommand& command, ReportPage page, const std::string& picture, Outputs& outputs) {
  if (!picture.empty()) page.pictures.push_back(outputs.take(picture, command.picture));
  write_report_page(page_name(command.mesh, "build"), page, outputs);
}

BuildCost cost_of(const BuildCommand& command, const SphereTreeOptions& options, double triangles) {
  const auto& sampling = options.medial.sampling;
  const double points = samples_surface(command.tree.method) && command.source.axis.empty()
                            ? static_cast<double>(sampling.face_points) + static_cast<double>(sampling.edge_points)
                            : 0;
  return estimated_cost(command.tree, options.axis, points, triangles);
}

// Before a long wait, or in place of it.
void print_cost(const BuildCommand& command, const BuildCost& cost) {
  const std::string text = in_words(cost, command.tree, command.cost);
  if (text.empty()) return;
  fmt::print("{}: {}\n", command.mesh.string(), text);
  std::fflush(stdout);
}

// For people: what was built, where it is, and `last_lines`.
void print_result(const BuildCommand& command, const SolidMesh& solid, const SphereTreeBuild& result,
                  const Outputs& outputs, const std::vector<std::string>& last_lines) {
  const Surface& surface = solid.surface;
  fmt::print("{}: {} triangles in {} clusters (flat parts), bounding radius {:.6g}{}\n", shown(command.mesh),
             surface.mesh().triangles.size(), surface.clusters().count(), surface.bounding_radius(),
             with_unit(solid.reading.unit));
  print_build(result, surface.bounding_radius(), solid.wrap ? solid.wrap->distance() : 0);
  const Index depth = result.tree.depth(), wanted = levels_of(command.tree);
  if (depth < wanted && command.tree.method == TreeMethod::tightened)
    fmt::print("{} of {} levels: for the next one nothing is left to refine, or there are too few --samples\n", depth,
               wanted);
  outputs.print();
  for (const std::string& line : last_lines) {
    if (!line.empty()) fmt::print("{}\n", line);
  }
}

}  // namespace

void check_options(const BuildCommand& command) {
  if (command.export_level) {
    const auto& exports = command.exports;
    if (std::find(exports.begin(), exports.end(), "urdf") == exports.end())
      throw InputError("--export-level needs --export urdf, the only format with the spheres of one level");
    if (const Index depth = levels_of(command.tree); *command.export_level > depth)
      throw InputError(fmt::format("--export-level {}: with --depth {} the tree has levels 0 to {}",
                                   *command.export_level, depth, depth));
  }
  if (is_given(command, "up") && !command.views && !command.picture && !command.page)
    throw InputError("--up has no effect with --no-views and without --picture or --report, because nothing is drawn");
  if (command.source.files().size() > 1) throw InputError("--points, --diagram and --from-axis exclude each other");
  refuse_unused_options(command);
  require_sizes(builder_of(command.tree));
  options_of(command);  // whether the numbers fit together
}

BuildCost expected_cost(const BuildCommand& command, double triangles) {
  return cost_of(command, options_of(command), triangles);
}

ExitCode build(const BuildCommand& command) {
  const Destination destination = check(command);
  const bool talk = !command.output.quiet && !command.output.json;
  const Stopwatch reading;
  ProgressBar bar(talk);
  const SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  const Surface& surface = solid.surface;
  const double seconds_reading = reading.seconds();
  bar.clear();
  const double wrap_distance = solid.wrap ? solid.wrap->distance() : 0;
  if (talk) print_solid(command.mesh, solid);
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, surface.bounding_radius());

  const SphereTreeOptions options = options_of(command);
  OwnInput own = read_axis_source(command.source, surface);
  if (talk) print_reading(command.source.points, own.reading);
  const BuildCost cost = cost_of(command, options, static_cast<double>(surface.mesh().triangles.size()));
  if (talk) print_cost(command, cost);
  if (command.cost && command.output.json) {
    nlohmann::json estimate = to_json(cost);
    estimate["provenance"] = to_json(destination.provenance);
    fmt::print("{}\n", estimate.dump(2));
  }
  if (command.cost) return kSucceeded;
  SphereTreeBuild result = command.seconds
                               ? build_sphere_tree_within(*command.seconds, surface, options, bar.callback(), own.input)
                               : build_sphere_tree(surface, options, bar.callback(), std::move(own.input));
  result.seconds.insert(result.seconds.begin(), {"reading", seconds_reading});
  bar.clear();

  nlohmann::json report;
  std::vector<plot::Plot> plots;
  tbb::parallel_invoke([&] { report = build_json(surface, command.tree, options, result, wrap_distance); },
                       [&] { plots = build_plots(result, surface, command.mesh.stem().string()); });
  add_solid_json(solid, report);
  const char* const ending = ending_of(solid);
  const Broken broken = apps::broken(result, command.tree.refinement);
  const std::string last_line = in_one_line(broken);
  report["promise"] = {{"kept", broken.none()}, {"broken", broken.what}};
  report["certified_mesh"] = ending ? nlohmann::json(named(command.mesh, ending)) : nlohmann::json();

  Outputs outputs(destination);
  const Stopwatch writing;
  write_trees(command, destination.provenance, result, outputs);
  write_solid(command, solid, outputs);
  const std::string picture = write_views(command, surface, result, outputs);
  write_file(outputs.add(named(command.mesh, "-levels.svg"), "this report as a plot"),
             plot::to_svg(plots, static_cast<int>(std::min<std::size_t>(3, plots.size()))));
  result.seconds.emplace_back("writing", writing.seconds());
  report["seconds"]["writing"] = writing.seconds();
  outputs.add_report(report, "this report as JSON");
  const std::string certified = certificate(solid, outputs.place_of(named(command.mesh, ending ? ending : "")));
  const std::string doubts = build_doubts(solid, result);
  if (command.page)
    write_page(command, {.report = report, .certificate = certified, .doubts = doubts}, picture, outputs);
  outputs.commit();

  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (talk) print_result(command, solid, result, outputs, {certified, doubts});
  if (!last_line.empty()) fmt::print(stderr, "orchard: {}: {}\n", command.mesh.string(), last_line);
  return exit_code(broken, command.accept);
}

}  // namespace orchard::apps
