// The command from its checks to its files, each step a few lines: hence its length.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "command_line/unused_options.h"
#include "input/input_file.h"
#include "input/reading_report.h"
#include "medial/axis_export.h"
#include "medial/axis_importance.h"
#include "medial/feature_lines.h"
#include "medial/medial_advice.h"
#include "medial/medial_report.h"
#include "medial/medial_run.h"
#include "medial/medial_simplify.h"
#include "medial/medial_table.h"
#include "medial/medial_trials.h"
#include "medial/medial_views.h"
#include "medial/medial_warning.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/outside_solid.h"
#include "orchard/medial/read_axis.h"
#include "output/json_values.h"
#include "output/outputs.h"
#include "output/promises.h"
#include "output/report.h"
#include "report/report_page.h"
#include "skeleton/solid_axis.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// Deviations of the noise that borders may lose beside what they lose anyway. Smoothing leaves a third to a half of the
// noise, in waves that are too long to be told from the shape, and what they raise on the axis loses less than this.
constexpr double kLossOfNoise = 1.5;
constexpr const char* kSmoothedEnding = "-smoothed.obj";
constexpr double kDistanceAccuracy = 1e-4;  // of the diagonal: to which the largest distance of two axes is searched

SegmentOptions segment_options(const MedialCommand& command, const Surface& surface, const MedialBuild& build) {
  // Below twice the mean spacing of the points, what they show is the points.
  const double spacing = std::sqrt(surface.report().area / build.sampling.size());
  return {.touching = 2 * spacing, .angle = command.tuning.segment_degrees * std::numbers::pi / 180};
}

// Every name that the command may write to.
std::vector<std::string> names_of(const MedialCommand& command) {
  if (!command.sweep.empty()) return sweep_names(command);
  std::vector<std::string> names = few_balls_names(command);
  const std::vector<std::string> exports = axis_export_names(command);
  names.insert(names.end(), exports.begin(), exports.end());
  const std::vector<std::string> curves = importance_file_names(command);
  names.insert(names.end(), curves.begin(), curves.end());
  if (!command.axis.empty()) {
    names.push_back(named(command.axis, "-quality.png"));
    names.push_back(page_name(command.axis, "medial"));
    return names;
  }
  names.push_back(page_name(command.mesh, "medial"));
  for (const std::string& name : view_names(command.mesh)) names.push_back(name);
  for (const char* ending : {".ma", ".graphml", "-features.obj", kSmoothedEnding})
    names.push_back(named(command.mesh, ending));
  return names;
}

void check_side(const MedialCommand& command) {
  if (!command.outside) {
    if (given(command, "outside-radius")) throw InputError("--outside-radius belongs to --side outside");
    return;
  }
  for (const char* option : {"sweep", "points", "diagram", "open-rounds"}) {
    if (given(command, option)) throw InputError(fmt::format("--{} has no effect with --side outside", option));
  }
}

// By which a later run knows whose the files are; they are named for the axis where one is judged.
std::string report_name(const MedialCommand& command) {
  if (!command.axis.empty()) return named(command.axis, "-quality.json");
  return named(command.mesh, command.sweep.empty() ? "-medial.json" : "-sweep.json");
}

// What can be refused before anything is built; then where the files go.
Destination check(const MedialCommand& command) {
  check_options(command);
  std::vector<fs::path> inputs = command.source.files();
  if (!command.axis.empty()) inputs.push_back(command.axis);
  inputs.insert(inputs.end(), command.beside.begin(), command.beside.end());
  if (!command.features.empty()) inputs.push_back(command.features);
  inputs.insert(command.axis.empty() ? inputs.begin() : inputs.begin() + 1, command.mesh);
  for (const fs::path& file : inputs) check_input(file);
  Destination destination{.folder = command.folder,
                          .report = report_name(command),
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  std::vector<std::string> singles;
  if (command.axis.empty()) singles = {named(command.mesh, ".ma"), named(command.mesh, ".graphml")};
  for (const std::string& name : axis_export_names(command)) singles.push_back(name);
  keep_single_file(destination, singles);
  check_outputs(destination, names_of(command), inputs);
  check_few_balls(command, destination, inputs);
  return destination;
}

void finish(const MedialCommand& command, json& report, const std::string& picture, Outputs& outputs) {
  outputs.add_report(report, "this report as JSON");
  if (command.report)
    write_report_page(page_name(command.axis.empty() ? command.mesh : command.axis, "medial"), page_of(report, picture),
                      outputs);
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (!command.output.quiet && !command.output.json) outputs.print();
}

// The axes of files, read before anything takes long.
std::vector<ForeignAxis> read_axes(const std::vector<fs::path>& files) {
  std::vector<ForeignAxis> axes;
  axes.reserve(files.size());
  for (const fs::path& file : files) axes.push_back(read_axis(file));
  return axes;
}

// The same for one solid.
struct AxisFile {
  fs::path file;
  PlacedAxis axis;
};
std::vector<AxisFile> place_axes(const Surface& surface, std::vector<ForeignAxis> axes, const PlaceOptions& options) {
  std::vector<AxisFile> placed;
  placed.reserve(axes.size());
  for (ForeignAxis& axis : axes) {
    const fs::path file = axis.files.front();
    placed.push_back({file, place_axis(surface, std::move(axis), options)});
  }
  return placed;
}
void print_notes(const AxisFile& axis) {
  for (const std::string& note : axis.axis.notes) fmt::print("{}: {}\n", axis.file.string(), note);
}

json counts_of(const MedialMesh& mesh) {
  return {{"vertices", mesh.centers.size()}, {"edges", mesh.edges.size()}, {"triangles", mesh.triangles.size()}};
}

// What the whole report of one axis needs.
struct Judged {
  const MedialMesh& mesh;
  MedialJudgement judgement;
  AxisOrigin origin;
  std::string name;
};

// The first axis and those beside it in one table, and where the first one is worst: printed, and into `report`.
// Returns the axes for a picture.
std::vector<PicturedAxis> report_quality(const MedialCommand& command, const Destination& destination,
                                         const SolidMesh& solid, const Judged& first,
                                         const std::vector<AxisFile>& beside, json& report, const Progress& progress,
                                         ProgressBar& bar) {
  std::vector<JudgedAxis> axes{{first.name, first.judgement}};
  std::vector<PicturedAxis> pictured{{"", &first.mesh, first.judgement.quality.worst}};
  json others = json::array();
  StageTimes seconds = first.judgement.seconds;
  const Stopwatch measuring;
  for (const AxisFile& other : beside) {
    const MedialJudgement judgement = judge_beside(command, solid.surface, other.axis.mesh, first.mesh, progress);
    axes.push_back({other.file.string(), judgement});
    pictured.push_back({other.file.filename().string(), &other.axis.mesh, judgement.quality.worst});
    json row = counts_of(other.axis.mesh);
    row["axis"] = other.file.string();
    row["notes"] = other.axis.notes;
    row["quality"] = to_json(judgement);
    others.push_back(std::move(row));
  }
  if (!beside.empty()) seconds.emplace_back("axes beside it", measuring.seconds());
  bar.clear();
  std::vector<MedialTrial> trials = earlier_trials(destination.folder / destination.report, destination.provenance);
  const MedialTrial now = trial_of(destination.provenance, first.judgement.quality.worst);
  std::vector<ReportedPlace> places;
  for (const WorstPlace& place : first.judgement.quality.worst)
    places.push_back({place, advice_after(trials, now, advice(place, solid.surface, first.origin), place)});
  std::erase_if(trials, [&](const MedialTrial& trial) { return trial.options == now.options; });
  trials.push_back(now);
  add_quality(first.judgement, report);
  report["trials"] = to_json(trials);
  if (!beside.empty()) report["beside"] = std::move(others);
  report["worst_places"] = to_json(places);
  report["report_seconds"] = seconds_json(seconds);
  if (command.output.quiet || command.output.json) return pictured;
  print_table(axes, {"stability_max", "economy_spheres"});
  print(places);
  for (const auto& [stage, time] : seconds) fmt::print("  {:<18} {:>8.2f} s\n", stage, time);
  return pictured;
}

void judge_file(const MedialCommand& command, const Destination& destination, const SolidMesh& solid,
                const std::vector<AxisFile>& beside, const AxisFile& axis, const Progress& progress, ProgressBar& bar) {
  const bool talk = !command.output.quiet && !command.output.json;
  const MedialMesh& mesh = axis.axis.mesh;
  MedialJudgement judgement;
  time_stage(judgement.seconds, "quality",
             [&] { judgement = judge_mesh(solid.surface, mesh, quality_options(command), progress); });
  const Judged judged{.mesh = mesh, .judgement = std::move(judgement), .origin = {}, .name = command.axis.string()};
  bar.clear();
  json report = counts_of(mesh);
  report["mesh"] = mesh_json(solid.surface);
  report["axis"] = command.axis.string();
  report["notes"] = axis.axis.notes;
  add_solid_json(solid, report);
  if (talk) {
    fmt::print("{}: {} vertices, {} edges, {} triangles\n", command.axis.string(), mesh.centers.size(),
               mesh.edges.size(), mesh.triangles.size());
    print_notes(axis);
    for (const AxisFile& other : beside) print_notes(other);
  }
  const FewBalls few = make_few_balls(command, solid.surface, mesh, progress);
  const std::vector<PicturedAxis> pictured =
      report_quality(command, destination, solid, judged, beside, report, progress, bar);
  Outputs outputs(destination);
  write_few_balls(command, destination.provenance, few, report, outputs);
  write_axis_exports(command, mesh, axis_contacts(solid.surface, mesh), {}, outputs);
  const std::string picture =
      write_picture(command, solid.surface, pictured, nullptr, named(command.axis, "-quality.png"), outputs);
  finish(command, report, picture, outputs);
}

// What the command promised beside what it made; the line that says so comes last.
Broken broken_promises(const MedialCommand& command, const SolidMesh& solid, const MedialBuild& build,
                       const MedialFindings& findings, const FewBalls& few) {
  Broken result = broken(build.promise);
  const bool is_gap = !build.promise.keeps_topology() || !findings.mended || findings.own_diagram;
  if (!result.none() && (is_gap || solid.self_intersections.value_or(0) > 0)) {
    result.remedy = topology_cause(solid, build, findings);
  } else if (!result.none()) {
    result.remedy = findings.own_points ? "more points may help" : "more --samples may help";
  }
  const bool promised = build.promise.promise.topology && build.promise.keeps_topology();
  result.add(broken(few, few_balls_options(command), promised ? findings.wanted : findings.found));
  return result;
}

// `inner`: the solid itself where `solid` is the space around it, else none.
ExitCode build_axis(const MedialCommand& command, const Destination& destination, const SolidMesh& solid,
                    const Surface* inner, const std::vector<AxisFile>& beside, const Progress& progress,
                    ProgressBar& bar) {
  const Surface& surface = solid.surface;
  const bool talk = !command.output.quiet && !command.output.json;
  MedialBuildOptions options = build_options(command.tuning);
  if (!command.features.empty()) options.refine->features = read_feature_lines(command.features, surface);
  OwnInput own = read_axis_source(command.source, surface);
  if (talk) print_reading(command.source.points, own.reading);
  if (inner != nullptr) own.input.sampling = sample_outside(*inner, surface, options.sampling, progress);
  const MedialBuild build = build_medial_axis(surface, options, progress, std::move(own.input));
  const MedialMesh mesh = medial_mesh(build.axis);
  const MedialSegments segments = medial_segments(build.axis, segment_options(command, surface, build));
  const StructureGraph graph = structure_graph(build.axis);
  const FewBalls few = make_few_balls(command, surface, mesh, progress);
  const AxisImportance importance = measure_importance(command, surface, build.axis, progress);
  std::optional<MedialJudgement> judgement;
  if (command.report) judgement = judge(command, surface, build, mesh, options, progress);
  bar.clear();

  const Topology found = topology(mesh), wanted = solid_topology(surface);
  const MedialFindings findings{.found = found,
                                .wanted = wanted,
                                .mended = options.repair_gaps,
                                .own_points = !command.source.points.empty(),
                                .own_diagram = !command.source.diagram.empty()};
  const std::string warning = medial_warning(solid, build, findings);
  const Broken broken = broken_promises(command, solid, build, findings, few);
  const std::string last_line = in_one_line(broken);
  json report = axis_report(command, solid, build, mesh);
  if (!command.source.points.empty()) report["points_moved_at_most"] = own.max_moved;
  if (!warning.empty()) report["warning"] = warning;
  report["promise"]["broken"] = broken.what;
  report["promise"]["kept"] = broken.none();
  if (talk) {
    fmt::print("{}: {} triangles\n", command.mesh.string(), surface.mesh().triangles.size());
    if (!command.source.points.empty()) fmt::print("points moved onto the mesh by {:.6g} at most\n", own.max_moved);
    print(build);
    print(medial_structure(mesh));
    fmt::print("{} segments, structure graph of {} nodes and {} arcs\n", segments.segments.size(), graph.nodes.size(),
               graph.arcs.size());
  }
  std::vector<PicturedAxis> pictured{{"", &mesh}};
  std::optional<MedialErrors> errors;
  if (judgement) {
    if (command.views)
      time_stage(judgement->seconds, "arrays of the views",
                 [&] { errors = medial_errors(surface, build, mesh, quality_options(command)); });
    const Judged judged{.mesh = mesh,
                        .judgement = std::move(*judgement),
                        .origin = {.tuning = &command.tuning,
                                   .own_points = !command.source.files().empty(),
                                   .cuts_itself = solid.self_intersections.value_or(0) > 0},
                        .name = "this axis"};
    pictured = report_quality(command, destination, solid, judged, beside, report, progress, bar);
  }
  Outputs outputs(destination);
  write_axis(command, build, mesh, importance.arrays, last_line, outputs);
  if (!build.features.empty())
    write_file(outputs.add(named(command.mesh, "-features.obj"), "the edges of the mesh that its sheets reach"),
               to_feature_lines(surface, build.features));
  if (solid.is_smoothed())
    write_obj(outputs.add(named(command.mesh, kSmoothedEnding), "the mesh without its noise, whose axis this is"),
              surface.mesh());
  write_file(outputs.add(named(command.mesh, ".graphml"), "its structure graph"), to_graphml(graph, build.axis));
  write_few_balls(command, destination.provenance, few, report, outputs);
  write_importance(command, importance, report, outputs);
  write_views(command,
              {.surface = surface,
               .build = build,
               .segments = segments,
               .graph = graph,
               .mesh = mesh,
               .errors = errors ? &*errors : nullptr,
               .importance = importance.arrays,
               .worst = pictured.front().worst},
              outputs);
  const std::string picture =
      write_picture(command, surface, pictured, &build.sampling, named(command.mesh, "-medial.png"), outputs);
  finish(command, report, picture, outputs);
  if (!warning.empty() && build.promise.keeps_topology())
    fmt::print(stderr, "orchard: warning: {}: {}\n", command.mesh.string(), warning);
  if (!last_line.empty()) fmt::print(stderr, "orchard: {}: {}\n", command.mesh.string(), last_line);
  return exit_code(broken, command.accept);
}

}  // namespace

json axis_report(const MedialCommand& command, const SolidMesh& solid, const MedialBuild& build,
                 const MedialMesh& mesh) {
  const MedialSegments segments = medial_segments(build.axis, segment_options(command, solid.surface, build));
  json report{{"mesh", mesh_json(solid.surface)},
              {"build", to_json(build)},
              {"topology", to_json(topology(mesh))},
              {"topology_of_solid", to_json(solid_topology(solid.surface))},
              {"promise", to_json(build.promise)},
              {"structure", to_json(segments, structure_graph(build.axis), medial_structure(mesh))}};
  const Broken broken = apps::broken(build.promise);
  report["promise"]["broken"] = broken.what;
  report["promise"]["kept"] = broken.none();  // what could not be proven is not kept
  add_solid_json(solid, report);
  return report;
}

void write_axis(const MedialCommand& command, const MedialBuild& build, const MedialMesh& mesh,
                const std::vector<ImportanceArray>& importance, const std::string& last_line, Outputs& outputs) {
  write_file(
      outputs.add(named(command.mesh, ".ma"), "the axis for medial-mesh programs"),
      to_ma(mesh) + to_structure_section(medial_structure(mesh)) + (last_line.empty() ? "" : "# " + last_line + "\n"));
  write_axis_exports(command, mesh, axis_contacts(build.axis), importance, outputs);
}

void add_quality(const MedialJudgement& judgement, json& report) {
  report["quality"] = to_json(judgement);
  report["diagonal"] = judgement.quality.diagonal;
}

MedialTuning tuning_for(const MedialCommand& command, const SolidMesh& solid) {
  MedialTuning tuning = command.tuning;
  if (!solid.is_smoothed()) return tuning;
  const RefineOptions standard;
  const double times = 1 + kLossOfNoise * solid.noise->deviation / standard.border_loss;
  if (!given(command, "border-loss")) tuning.refinement.border_loss = times * standard.border_loss;
  if (!given(command, "feature-loss")) tuning.refinement.feature_loss = times * standard.feature_loss;
  return tuning;
}

QualityOptions quality_options(const MedialCommand& command) {
  QualityOptions options{.seed = command.tuning.options.sampling.seed};
  const auto scaled = [&](Index standard) {
    const double share = static_cast<double>(command.quality_samples) / options.surface_samples;
    return std::max(Index{1}, static_cast<Index>(share * standard));
  };
  options.search = scaled(options.search);
  options.contact_cells = scaled(options.contact_cells);
  options.economy_candidates = scaled(options.economy_candidates);
  options.economy_samples = scaled(options.economy_samples);
  options.surface_samples = command.quality_samples;
  return options;
}

MedialJudgement judge(const MedialCommand& command, const Surface& surface, const MedialBuild& build,
                      const MedialMesh& mesh, const MedialBuildOptions& options, const Progress& progress) {
  MedialJudgement judgement;
  time_stage(judgement.seconds, "quality",
             [&] { judgement = judge_mesh(surface, mesh, quality_options(command), progress); });
  time_stage(judgement.seconds, "stability", [&] {
    judgement.stability = medial_stability(surface, build, options, {.seed = options.sampling.seed}, progress);
  });
  return judgement;
}

MedialJudgement judge_beside(const MedialCommand& command, const Surface& surface, const MedialMesh& mesh,
                             const MedialMesh& first, const Progress& progress) {
  MedialJudgement judgement = judge_mesh(surface, mesh, quality_options(command), progress);
  const double diagonal = judgement.quality.diagonal;
  AxisDistance distance = axis_distance(first, mesh, kDistanceAccuracy * diagonal);
  for (double* length : {&distance.max, &distance.max_gap, &distance.mean, &distance.max_from, &distance.max_to})
    *length /= diagonal;
  judgement.distance = distance;
  return judgement;
}

void check_options(const MedialCommand& command) {
  std::vector<fs::path> inputs = command.source.files();
  if (!command.axis.empty()) inputs.push_back(command.axis);
  if (inputs.size() > 1) throw InputError("--axis, --diagram and --points exclude each other");
  if (!inputs.empty() && !command.sweep.empty()) throw InputError("--sweep takes no --axis, --diagram or --points");
  check_side(command);
  check_axis_exports(command);
  check_importance(command);
  if (command.tree && command.sweep.empty())
    throw InputError("--tree belongs to a --sweep; orchard build builds a tree");
  refuse_unused_options(command);
  check_sweep(command);  // without a sweep, that of the one combination that there is
}

ExitCode medial(const MedialCommand& given_command) {
  MedialCommand command = given_command;
  for (MedialCommand& run : command.runs)
    run.mesh = command.mesh;  // where standard input is kept, if it came from there
  const Destination destination = check(command);
  std::vector<ForeignAxis> foreign = read_axes(command.beside);
  if (!command.axis.empty()) foreign.push_back(read_axis(command.axis));
  ProgressBar bar(!command.output.quiet && !command.output.json);
  if (!command.sweep.empty()) {
    sweep_medial(command, destination, bar);
    return kSucceeded;
  }
  const SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  bar.clear();
  if (!command.output.quiet && !command.output.json) print_solid(command.mesh, solid);
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, solid.surface.bounding_radius());
  command.tuning = tuning_for(command, solid);
  std::optional<SolidMesh> outside;
  if (command.outside) {
    outside = outside_of(solid, command.outside_radius);
    if (!command.output.quiet && !command.output.json)
      fmt::print("outside: the space around it, within a sphere of {:.6g} bounding radii\n", command.outside_radius);
  }
  const SolidMesh& wanted = outside ? *outside : solid;
  std::vector<AxisFile> beside = place_axes(wanted.surface, std::move(foreign), {.connect = command.connect});
  if (!command.axis.empty()) {
    const AxisFile axis = std::move(beside.back());
    beside.pop_back();
    judge_file(command, destination, wanted, beside, axis, bar.callback(), bar);
  } else {
    return build_axis(command, destination, wanted, outside ? &solid.surface : nullptr, beside, bar.callback(), bar);
  }
  return kSucceeded;
}

}  // namespace orchard::apps
