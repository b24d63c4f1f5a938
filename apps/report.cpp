#include "report.h"

#include <fmt/core.h>

#include "orchard/covering/inaccuracy.h"
#include "tree_options.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

json repair_json(const RepairReport& repair) {
  json passes = json::array();
  for (const RepairPass& pass : repair.passes)
    passes.push_back({{"faces_tested", pass.faces_tested},
                      {"faces_crossing", pass.faces_crossing},
                      {"added_by_projection", pass.added_by_projection},
                      {"added_by_snapping", pass.added_by_snapping},
                      {"refused_as_coincident", pass.refused_as_coincident}});
  return {
      {"passes", passes}, {"points_added", repair.points_added}, {"faces_still_crossing", repair.faces_still_crossing}};
}

json levels_json(const SphereTree& tree, double bounding_radius, double wrap_distance) {
  json levels = json::array();
  for (const LevelFigures& level : level_figures(tree, bounding_radius)) {
    json& row = levels.emplace_back(json{{"spheres", level.spheres},
                                         {"mean_inaccuracy_over_radius", level.mean_inaccuracy},
                                         {"max_inaccuracy_over_radius", level.max_inaccuracy}});
    if (wrap_distance == 0) continue;
    const double wrap = wrap_distance / bounding_radius;
    row["mean_inaccuracy_over_radius_including_wrap"] = level.mean_inaccuracy + wrap;
    row["max_inaccuracy_over_radius_including_wrap"] = level.max_inaccuracy + wrap;
  }
  return levels;
}

std::size_t packed_bytes(const runtime::PackedSphereTree& packed) {
  return packed.blocks.size() * sizeof(runtime::SiblingBlock);
}

}  // namespace

json mesh_json(const Surface& surface) {
  const MeshReport& report = surface.report();
  const Sphere& ball = surface.bounding_ball();
  return {{"vertices", report.vertices},
          {"triangles", report.triangles},
          {"components", report.components},
          {"euler_characteristic", report.euler_characteristic},
          {"boundary_edges", report.boundary_edges},
          {"non_manifold_edges", report.non_manifold_edges},
          {"non_manifold_vertices", report.non_manifold_vertices},
          {"misoriented_edges", report.misoriented_edges},
          {"degenerate_triangles", report.degenerate_triangles},
          {"clusters", surface.clusters().count()},
          {"area", report.area},
          {"volume", report.volume},
          {"solid", report.solid()},
          {"bounding_ball", {ball.center.x(), ball.center.y(), ball.center.z(), ball.radius}}};
}

json build_json(const Surface& surface, const BuildOptions& options, const BuildResult& result, double wrap_distance) {
  const double radius = surface.bounding_radius();
  json report;
  report["mesh"] = mesh_json(surface);
  report["options"] = {{"method", name(options.method)},
                       {"depth", options.depth},
                       {"branching", options.branching},
                       {"effort", name(options.effort)},
                       {"objective", name(options.objective)},
                       {"samples", options.samples.value_or(samples_needed(options))},
                       {"seed", options.seed}};
  if (result.axis) {
    report["surface_points"] = result.sampling.size();
    report["voronoi"] = {{"vertices", result.voronoi_vertices},
                         {"certified_insertions", result.voronoi.certified_insertions},
                         {"constrained_insertions", result.voronoi.constrained_insertions},
                         {"coplanar_centers", result.voronoi.coplanar_centers},
                         {"duplicates", result.voronoi.duplicates.size()}};
    report["gap_repair"] = repair_json(result.repair);
    report["medial_axis"] = {{"vertices", result.axis->size()},
                             {"faces", result.axis->faces.size()},
                             {"components", result.axis_components}};
  }
  report["covering"] = {{"rounds", result.cover.rounds},
                        {"triangles_uncovered_before", result.cover.triangles_uncovered},
                        {"largest_growth_over_radius", result.cover.largest_growth}};
  report["redundant_spheres_removed"] = result.redundancy.removed;
  report["levels"] = levels_json(result.tree, radius, wrap_distance);
  report["octree_levels"] = levels_json(result.octree, radius, wrap_distance);
  report["conservative"] = true;  // run_pipeline throws otherwise
  report["bytes_per_node"] =
      static_cast<double>(packed_bytes(result.packed)) / static_cast<double>(result.packed.node_count);
  for (const auto& [stage, seconds] : result.seconds) report["seconds"][stage] = seconds;
  return report;
}

void print_build(const BuildResult& result, double bounding_radius, double wrap_distance) {
  const double wrap = wrap_distance / bounding_radius;
  const auto levels = level_figures(result.tree, bounding_radius);
  const auto octree = level_figures(result.octree, bounding_radius);
  fmt::print("inaccuracy as a fraction of the bounding radius{}\n",
             wrap > 0 ? fmt::format(", including {:.5f} from the wrap to the mesh", wrap) : "");
  fmt::print("level  spheres      mean       max | octree:  spheres      mean       max | mean / octree's\n");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    fmt::print("{:5} {:8} {:9.5f} {:9.5f} |", i, levels[i].spheres, levels[i].mean_inaccuracy + wrap,
               levels[i].max_inaccuracy + wrap);
    if (i < octree.size())
      fmt::print("        {:9} {:9.5f} {:9.5f} | {:15.3f}", octree[i].spheres, octree[i].mean_inaccuracy + wrap,
                 octree[i].max_inaccuracy + wrap,
                 (levels[i].mean_inaccuracy + wrap) / (octree[i].mean_inaccuracy + wrap));
    fmt::print("\n");
  }
  if (result.axis)
    fmt::print(
        "{} surface points ({} by gap repair, {} cell faces still crossing), {} medial vertices in {} component{}\n",
        result.sampling.size(), result.repair.points_added, result.repair.faces_still_crossing, result.axis->size(),
        result.axis_components, result.axis_components == 1 ? "" : "s");
  fmt::print("{} redundant spheres removed\n", result.redundancy.removed);
  double total = 0;
  fmt::print("seconds:");
  for (const auto& [stage, seconds] : result.seconds) {
    fmt::print(" {} {:.2f},", stage, seconds);
    total += seconds;
  }
  fmt::print(" in all {:.2f}\n", total);
  fmt::print("conservative: every point of the surface is certified to lie in all spheres of a root-to-leaf path\n");
}

}  // namespace orchard::apps
