#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "commands.h"
#include "console.h"
#include "idle_options.h"
#include "input_file.h"
#include "medial_run.h"
#include "medial_warning.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "outputs.h"
#include "report.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/medial_writer.h"
#include "orchard/viz/vtk_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

SegmentOptions segment_options(const MedialCommand& command, const Surface& surface, const MedialBuild& build) {
  // Below twice the mean spacing of the points, what they show is the points.
  const double spacing = std::sqrt(surface.report().area / build.sampling.size());
  return {.touching = 2 * spacing, .angle = command.tuning.segment_degrees * std::numbers::pi / 180};
}

// Every name that the command may write to.
std::vector<std::string> names_of(const MedialCommand& command) {
  if (!command.axis.empty()) return {named(command.axis, "-quality.json")};
  if (!command.sweep.empty()) return sweep_names(command);
  std::vector<std::string> names;
  for (const char* ending :
       {".ma", ".graphml", "-medial.json", "-medial.vtu", "-medial.vtm", "-medial-vertices.vtp", "-medial-edges.vtp",
        "-medial-faces.vtp", "-medial-mesh.vtp", "-medial-points.vtp", "-medial-thickness.vtp", "-medial-skeleton.vtp"})
    names.push_back(named(command.mesh, ending));
  return names;
}

// What can be refused before anything is built.
void check(const MedialCommand& command) {
  std::vector<fs::path> inputs = command.source.files();
  if (!command.axis.empty()) inputs.push_back(command.axis);
  if (inputs.size() > 1) throw InputError("--axis, --diagram and --points exclude each other");
  if (!inputs.empty() && !command.sweep.empty()) throw InputError("--sweep takes no --axis, --diagram or --points");
  if (command.tree && command.sweep.empty())
    throw InputError("--tree belongs to a --sweep; orchard build builds a tree");
  refuse_idle_options(command);
  check_sweep(command);  // without a sweep, that of the one combination that there is
  inputs.push_back(command.mesh);
  for (const fs::path& file : inputs) check_input(file);
  check_outputs(command.folder, names_of(command), inputs);
}

void write_views(const MedialCommand& command, const Surface& surface, const MedialBuild& build,
                 const MedialSegments& segments, const SkeletonGraph& skeleton, const MedialMesh& mesh,
                 Outputs& outputs) {
#ifdef ORCHARD_HAS_VIZ
  if (!command.views) return;
  std::vector<NamedFile> shown;
  const auto add = [&](const std::string& ending, const char* block, const char* what = "") {
    const std::string name = named(command.mesh, "-medial" + ending);
    if (*block != '\0') shown.push_back({block, name});
    return outputs.add(name, what);
  };
  write_medial_grid(add(".vtu", "", "the axis with radius, angle, segment, component; open it in ParaView"), build.axis,
                    segments);
  write_mesh(add("-mesh.vtp", "mesh"), surface);
  write_points(add("-points.vtp", "surface points", "the surface points, and which of them repair added"),
               build.sampling);
  add("-vertices.vtp", "medial vertices");
  add("-edges.vtp", "medial edges");
  add("-faces.vtp", "medial faces", "its faces; edges and vertices likewise");
  write_medial_axis(outputs.staged(named(command.mesh, "-medial")), build.axis);
  write_thickness(add("-thickness.vtp", "", "the mesh with its local thickness"), surface,
                  medial_radii_at_surface(surface, mesh));
  write_skeleton(add("-skeleton.vtp", "skeleton", "the lines where sheets end and meet"), build.axis, skeleton);
  write_multiblock(add(".vtm", "", "open this in ParaView: mesh, points, axis and skeleton at once"), shown);
#else
  (void)command, (void)surface, (void)build, (void)segments, (void)skeleton, (void)mesh, (void)outputs;
#endif
}

void finish(const MedialCommand& command, const std::string& report_name, const json& report, Outputs& outputs) {
  write_file(outputs.add(report_name, "this report as JSON"), report.dump(2) + "\n");
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (!command.output.quiet && !command.output.json) outputs.print();
}

void judge_file(const MedialCommand& command, const SolidMesh& solid, const Progress& progress, ProgressBar& bar) {
  const MedialMesh mesh = read_ma(command.axis);
  const MedialJudgement judgement{.quality = medial_quality(solid.surface, mesh, quality_options(command), progress),
                                  .stability = {}};
  bar.clear();
  json report{{"mesh", mesh_json(solid.surface)}, {"axis", command.axis.string()}, {"quality", to_json(judgement)}};
  report["vertices"] = mesh.centers.size();
  report["edges"] = mesh.edges.size();
  report["triangles"] = mesh.triangles.size();
  add_solid_json(solid, report);
  if (!command.output.quiet && !command.output.json) {
    fmt::print("{}: {} vertices, {} edges, {} triangles\n", command.axis.string(), mesh.centers.size(),
               mesh.edges.size(), mesh.triangles.size());
    print(judgement);
  }
  Outputs outputs(command.folder);
  finish(command, named(command.axis, "-quality.json"), report, outputs);
}

void build_axis(const MedialCommand& command, const SolidMesh& solid, const Progress& progress, ProgressBar& bar) {
  const Surface& surface = solid.surface;
  const bool talk = !command.output.quiet && !command.output.json;
  const MedialBuildOptions options = build_options(command.tuning);
  OwnInput own = read_axis_source(command.source, surface);
  const MedialBuild build = build_medial_axis(surface, options, progress, std::move(own.input));
  const MedialMesh mesh = medial_mesh(build.axis);
  const MedialSegments segments = medial_segments(build.axis, segment_options(command, surface, build));
  const SkeletonGraph skeleton = skeleton_graph(build.axis);
  std::optional<MedialJudgement> judgement;
  if (command.report) judgement = judge(command, surface, build, mesh, options, progress);
  bar.clear();

  const Topology found = topology(mesh), wanted = solid_topology(surface);
  const std::string warning = medial_warning(solid, build,
                                             {.found = found,
                                              .wanted = wanted,
                                              .mended = options.repair_gaps,
                                              .own_points = !command.source.points.empty(),
                                              .own_diagram = !command.source.diagram.empty()});
  json report{{"mesh", mesh_json(surface)},
              {"build", to_json(build)},
              {"topology", to_json(found)},
              {"topology_of_solid", to_json(wanted)},
              {"structure", to_json(segments, skeleton)}};
  if (!command.source.points.empty()) report["points_moved_at_most"] = own.max_moved;
  if (judgement) report["quality"] = to_json(*judgement);
  if (!warning.empty()) report["warning"] = warning;
  add_solid_json(solid, report);
  if (talk) {
    fmt::print("{}: {} triangles\n", command.mesh.string(), surface.mesh().triangles.size());
    if (!command.source.points.empty()) fmt::print("points moved onto the mesh by {:.6g} at most\n", own.max_moved);
    print(build);
    fmt::print("{} segments, skeleton of {} nodes and {} arcs\n", segments.segments.size(), skeleton.nodes.size(),
               skeleton.arcs.size());
    if (judgement) print(*judgement);
  }
  Outputs outputs(command.folder);
  write_file(outputs.add(named(command.mesh, ".ma"), "the axis for medial-mesh programs"), to_ma(mesh));
  write_file(outputs.add(named(command.mesh, ".graphml"), "its skeleton graph"), to_graphml(skeleton, build.axis));
  write_views(command, surface, build, segments, skeleton, mesh, outputs);
  finish(command, named(command.mesh, "-medial.json"), report, outputs);
  if (!warning.empty()) fmt::print(stderr, "orchard: warning: {}: {}\n", command.mesh.string(), warning);
}

}  // namespace

QualityOptions quality_options(const MedialCommand& command) {
  QualityOptions options{.seed = command.tuning.options.sampling.seed};
  const auto scaled = [&](Index standard) {
    const double share = static_cast<double>(command.quality_samples) / options.surface_samples;
    return std::max(Index{1}, static_cast<Index>(share * standard));
  };
  options.contact_cells = scaled(options.contact_cells);
  options.economy_candidates = scaled(options.economy_candidates);
  options.economy_samples = scaled(options.economy_samples);
  options.surface_samples = command.quality_samples;
  return options;
}

MedialJudgement judge(const MedialCommand& command, const Surface& surface, const MedialBuild& build,
                      const MedialMesh& mesh, const MedialBuildOptions& options, const Progress& progress) {
  return {.quality = medial_quality(surface, mesh, quality_options(command), progress),
          .stability = medial_stability(surface, build, options, {.seed = options.sampling.seed}, progress)};
}

void medial(const MedialCommand& command) {
  check(command);
  ProgressBar bar(!command.output.quiet && !command.output.json);
  const SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  bar.clear();
  if (!command.output.quiet && !command.output.json) print_solid(command.mesh, solid);
  if (!command.axis.empty()) {
    judge_file(command, solid, bar.callback(), bar);
  } else if (!command.sweep.empty()) {
    sweep_medial(command, solid.surface, bar.callback());
    bar.clear();
  } else {
    build_axis(command, solid, bar.callback(), bar);
  }
}

}  // namespace orchard::apps
