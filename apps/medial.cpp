#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "commands.h"
#include "console.h"
#include "medial_run.h"
#include "medial_warning.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "output_folder.h"
#include "report.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/medial_writer.h"
#include "orchard/viz/vtk_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

using Written = std::vector<std::pair<fs::path, std::string>>;

SegmentOptions segment_options(const MedialCommand& command, const Surface& surface, const MedialBuild& build) {
  // Below twice the mean spacing of the points, what they show is the points.
  const double spacing = std::sqrt(surface.report().area / build.sampling.size());
  return {.touching = 2 * spacing, .angle = command.tuning.segment_degrees * std::numbers::pi / 180};
}

void write_views(const MedialCommand& command, const Surface& surface, const MedialBuild& build,
                 const MedialSegments& segments, const SkeletonGraph& skeleton, const MedialMesh& mesh,
                 Written& written) {
#ifdef ORCHARD_HAS_VIZ
  if (!command.views) return;
  const auto add = [&](const char* name, const char* what) { written.emplace_back(command.folder / name, what); };
  write_medial_grid(command.folder / "medial.vtu", build.axis, segments);
  add("medial.vtu", "the axis with radius, angle, segment, component; open it in ParaView");
  write_medial_axis(command.folder, build.axis);
  add("medial_faces.vtp", "its faces; medial_edges.vtp, medial_vertices.vtp likewise");
  write_mesh(command.folder / "mesh.vtp", surface);
  write_points(command.folder / "points.vtp", build.sampling);
  add("points.vtp", "the surface points, and which of them repair added");
  write_thickness(command.folder / "thickness.vtp", surface, medial_radii_at_surface(surface, mesh));
  add("thickness.vtp", "the mesh with its local thickness");
  write_skeleton(command.folder / "skeleton.vtp", build.axis, skeleton);
  add("skeleton.vtp", "the lines where sheets end and meet");
#else
  (void)command, (void)surface, (void)build, (void)segments, (void)skeleton, (void)mesh, (void)written;
#endif
}

void finish(const MedialCommand& command, const fs::path& report_file, const json& report, Written written) {
  write_file(report_file, report.dump(2) + "\n");
  written.emplace_back(report_file, "this report as JSON");
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (command.output.quiet || command.output.json) return;
  for (const auto& [file, what] : written) fmt::print("  {}  ({})\n", file.string(), what);
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
  finish(command, in_folder(command.folder, command.axis, "-quality.json"), report, {});
}

void build_axis(const MedialCommand& command, const SolidMesh& solid, const Progress& progress, ProgressBar& bar) {
  const Surface& surface = solid.surface;
  const bool talk = !command.output.quiet && !command.output.json;
  const MedialBuildOptions options = build_options(command.tuning);
  double moved = 0;
  const auto run = [&] {
    if (!command.diagram.empty())
      return build_medial_axis(surface, read_own_diagram(command.diagram, surface), options, progress);
    if (command.points.empty()) return build_medial_axis(surface, options, progress);
    OwnPoints own = read_own_points(command.points, surface);
    moved = own.farthest_moved;
    return build_medial_axis(surface, options, progress, std::move(own.sampling));
  };
  const MedialBuild build = run();
  const MedialMesh mesh = medial_mesh(build.axis);
  const MedialSegments segments = medial_segments(build.axis, segment_options(command, surface, build));
  const SkeletonGraph skeleton = skeleton_graph(build.axis);
  std::optional<MedialJudgement> judgement;
  if (command.report) judgement = judge(command, surface, build, mesh, options, progress);
  bar.clear();

  Written written;
  const fs::path ma = in_folder(command.folder, command.mesh, ".ma");
  write_file(ma, to_ma(mesh));
  written.emplace_back(ma, "the axis for medial-mesh programs");
  const fs::path graphml = in_folder(command.folder, command.mesh, ".graphml");
  write_file(graphml, to_graphml(skeleton, build.axis));
  written.emplace_back(graphml, "its skeleton graph");
  write_views(command, surface, build, segments, skeleton, mesh, written);

  const Topology found = topology(mesh), wanted = solid_topology(surface);
  const bool mended = options.mend_gaps && command.diagram.empty();
  const std::string warning = medial_warning(solid, build, found, wanted, mended);
  json report{{"mesh", mesh_json(surface)},
              {"build", to_json(build)},
              {"topology", to_json(found)},
              {"topology_of_solid", to_json(wanted)},
              {"structure", to_json(segments, skeleton)}};
  if (!command.points.empty()) report["points_moved_at_most"] = moved;
  if (judgement) report["quality"] = to_json(*judgement);
  if (!warning.empty()) report["warning"] = warning;
  add_solid_json(solid, report);
  if (talk) {
    fmt::print("{}: {} triangles\n", command.mesh.string(), surface.mesh().triangles.size());
    if (!command.points.empty()) fmt::print("points moved onto the mesh by {:.6g} at most\n", moved);
    print(build);
    fmt::print("{} segments, skeleton of {} nodes and {} arcs\n", segments.segments.size(), skeleton.nodes.size(),
               skeleton.arcs.size());
    if (judgement) print(*judgement);
  }
  finish(command, in_folder(command.folder, command.mesh, "-medial.json"), report, std::move(written));
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
  const int own_input = !command.axis.empty() + !command.diagram.empty() + !command.points.empty();
  if (own_input > 1) throw InputError("--axis, --diagram and --points exclude each other");
  if (own_input > 0 && !command.sweep.empty()) throw InputError("--sweep takes no --axis, --diagram or --points");
  ProgressBar bar(!command.output.quiet && !command.output.json);
  const SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  bar.clear();
  if (!command.output.quiet && !command.output.json) print_solid(command.mesh, solid);
  make_folder(command.folder);
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
