#include "output/report.h"

#include <fmt/core.h>

#include <algorithm>

#include "command_line/tree_options.h"
#include "orchard/covering/inaccuracy.h"
#include "orchard/spheretree/outside_volume.h"
#include "output/json_values.h"
#include "output/sphere_lists.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

json repair_json(const GapRepairReport& repair) {
  json passes = json::array();
  for (const GapRepairPass& pass : repair.passes)
    passes.push_back({{"faces_tested", pass.faces_tested},
                      {"faces_crossing", pass.faces_crossing},
                      {"added_by_projection", pass.added_by_projection},
                      {"added_by_snapping", pass.added_by_snapping},
                      {"refused_as_coincident", pass.refused_as_coincident}});
  return {
      {"passes", passes}, {"points_added", repair.points_added}, {"faces_still_crossing", repair.faces_still_crossing}};
}

constexpr std::size_t kHistogramBins = 20;

// How many balls have an inaccuracy in each twentieth of the range up to the level's largest.
json histogram(const SphereTree& tree, Index level, double max) {
  std::vector<Index> bins(kHistogramBins, 0);
  for (const SphereNode& node : tree.nodes) {
    if (node.level != level) continue;
    const double part = max > 0 ? node.inaccuracy / max : 0;
    ++bins[std::min(kHistogramBins - 1, static_cast<std::size_t>(part * kHistogramBins))];
  }
  return bins;
}

// With the figures of the octree's levels to compare with, and the volume outside, where they are given.
json levels_json(const SphereTree& tree, double bounding_radius, double wrap_distance,
                 const SphereTree* octree = nullptr, const Surface* surface = nullptr) {
  json levels = json::array();
  const auto figures = level_figures(tree, bounding_radius);
  const auto others = octree ? level_figures(*octree, bounding_radius) : figures;
  const SphereLists lists = levels_of(tree);
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const LevelFigures& level = figures[i];
    const double max = level.max_inaccuracy * bounding_radius;
    json& row = levels.emplace_back(json{{"spheres", level.spheres},
                                         {"mean_inaccuracy", level.mean_inaccuracy * bounding_radius},
                                         {"max_inaccuracy", max},
                                         {"mean_inaccuracy_over_radius", level.mean_inaccuracy},
                                         {"max_inaccuracy_over_radius", level.max_inaccuracy},
                                         {"histogram_up_to_max", histogram(tree, static_cast<Index>(i), max)},
                                         {"histogram_bin", max / kHistogramBins},
                                         {"histogram_bin_over_radius", level.max_inaccuracy / kHistogramBins}});
    if (octree && i < others.size() && others[i].mean_inaccuracy > 0) {
      row["mean_inaccuracy_over_octree"] = level.mean_inaccuracy / others[i].mean_inaccuracy;
      row["histogram_bin_over_octree_mean"] = level.max_inaccuracy / others[i].mean_inaccuracy / kHistogramBins;
      row["max_inaccuracy_over_octree"] = level.max_inaccuracy / others[i].max_inaccuracy;
    }
    if (surface && surface->solid()) {
      Level all = lists.levels[i];
      all.insert(all.end(), lists.carried[i].begin(), lists.carried[i].end());
      const double outside = outside_volume(*surface, all);
      row["outside_volume"] = outside;
      row["outside_volume_over_solid"] = outside / surface->report().volume;
    }
    if (wrap_distance == 0) continue;
    const double wrap = wrap_distance / bounding_radius;
    row["mean_inaccuracy_over_radius_including_wrap"] = level.mean_inaccuracy + wrap;
    row["max_inaccuracy_over_radius_including_wrap"] = level.max_inaccuracy + wrap;
  }
  return levels;
}

json tightening_json(const TightenReport& report) {
  json levels = json::array();
  for (const TightenReport::Level& level : report.levels)
    levels.push_back({{"balls", level.balls},
                      {"gaps_closed", level.uncovered_regions},
                      {"closing_rounds", level.closing_rounds},
                      {"max_growth_over_radius", level.grown},
                      {"seconds_search", level.seconds_search},
                      {"seconds_closing", level.seconds_closing}});
  return levels;
}

json merging_json(const MergeReport& report) {
  json levels = json::array();
  for (const MergeReport::Level& level : report.levels)
    levels.push_back({{"spheres", level.spheres},
                      {"redundant_spheres_removed", level.removed},
                      {"loose_spheres_split", level.split},
                      {"uncovered_regions_before", level.uncovered_regions},
                      {"closing_rounds", level.rounds},
                      {"max_growth_over_radius", level.growth}});
  return levels;
}

std::size_t packed_bytes(const runtime::PackedSphereTree& packed) {
  return packed.blocks.size() * sizeof(runtime::SiblingBlock);
}

void print_axis(const MedialBuild& medial, Index components) {
  if (medial.diagram.vertices.empty()) {
    fmt::print("{} balls of the axis given ({} outside the solid refused, {} radii corrected, by {:.6g} at most)",
               medial.unpruned_vertices, medial.balls_refused, medial.balls_adjusted, medial.ball_adjustment);
  } else {
    fmt::print("{} surface points ({} by gap repair, {} cell faces still crossing gaps between parts of the surface)",
               medial.sampling.size(), medial.gap_repair.points_added, medial.gap_repair.faces_still_crossing);
  }
  fmt::print(", {} medial vertices in {} component{}\n", medial.axis.size(), components, components == 1 ? "" : "s");
}

json axis_json(const MedialBuild& medial, Index components) {
  json report{{"surface_points", medial.sampling.size()},
              {"gap_repair", repair_json(medial.gap_repair)},
              {"medial_axis",
               {{"vertices", medial.axis.size()},
                {"vertices_before_pruning", medial.unpruned_vertices},
                {"faces", medial.axis.faces.size()},
                {"components", components}}}};
  if (medial.diagram.vertices.empty()) {
    report["imported_axis"] = {{"balls_refused", medial.balls_refused},
                               {"balls_adjusted", medial.balls_adjusted},
                               {"max_adjustment", medial.ball_adjustment}};
  } else {
    report["voronoi"] = {{"vertices", medial.diagram.vertices.size()},
                         {"certified_insertions", medial.voronoi.certified_insertions},
                         {"constrained_insertions", medial.voronoi.constrained_insertions},
                         {"coplanar_centers", medial.voronoi.coplanar_centers},
                         {"duplicates", medial.voronoi.duplicates.size()}};
  }
  return report;
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
          {"diagonal", surface.bounding_box().diagonal().norm()},
          {"area", report.area},
          {"volume", report.volume},
          {"solid", report.solid()},
          {"bounding_ball", {ball.center.x(), ball.center.y(), ball.center.z(), ball.radius}}};
}

json build_json(const Surface& surface, const TreeRequest& tree, const SphereTreeOptions& options,
                const SphereTreeBuild& result, double wrap_distance) {
  const double radius = surface.bounding_radius();
  json report;
  report["mesh"] = mesh_json(surface);
  const TreeMethod method = method_of(result.tree_options);
  const auto* tightened = std::get_if<TightenOptions>(&result.tree_options);  // with --time these are the best ones
  report["options"] = {{"method", name(method)},
                       {"depth", levels_of(tree)},
                       {"branching", tree.branching},
                       {"effort", name(tightened ? tightened->effort : tree.effort)},
                       {"objective", name(tree.objective)},
                       {"closing", tree.closing == MergeClosing::refit ? "refit" : "growth"},
                       {"redundant", name(tree.redundancy)},
                       {"seed", tightened ? tightened->seed : options.medial.sampling.seed}};
  if (!tree.spheres.empty()) report["options"]["spheres"] = tree.spheres;
  if (result.points > 0) report["options"]["samples"] = result.points;
  if (result.medial) report.update(axis_json(*result.medial, result.axis_components));
  if (!result.medial && result.points > 0) report["surface_points"] = result.points;
  report["covering"] = {{"rounds", result.cover.rounds},
                        {"triangles_uncovered_before", result.cover.triangles_uncovered},
                        {"max_growth_over_radius", result.cover.max_growth}};
  if (method == TreeMethod::tightened) report["tightening"] = tightening_json(result.tightening);
  if (method == TreeMethod::merging && tree.closing == MergeClosing::refit)
    report["merging"] = merging_json(result.merging);
  if (method == TreeMethod::annealing || options.anneal)
    report["annealing"] = {{"changes", result.annealing.changes},
                           {"refused_as_uncovering", result.annealing.uncovering},
                           {"accepted", result.annealing.accepted},
                           {"redundant_spheres_removed", result.annealing.redundant}};
  if (options.descent)
    report["random_descent"] = {{"trials", result.descent.trials},
                                {"accepted", result.descent.accepted},
                                {"looseness_before_over_radius", result.descent.looseness_before},
                                {"looseness_after_over_radius", result.descent.looseness_after}};
  report["redundant_spheres_removed"] = result.redundancy.removed;
  report["levels"] = levels_json(result.tree, radius, wrap_distance, &result.octree, &surface);
  report["octree_levels"] = levels_json(result.octree, radius, wrap_distance);
  report["conservative"] = true;  // build_sphere_tree() throws otherwise
  report["nodes_with_weakened_bounds"] = result.bounds_weakened;
  report["bytes_per_node"] =
      static_cast<double>(packed_bytes(result.packed)) / static_cast<double>(result.packed.node_count);
  report["seconds"] = seconds_json(result.seconds);
  return report;
}

void print_build(const SphereTreeBuild& result, double bounding_radius, double wrap_distance) {
  const double wrap = wrap_distance / bounding_radius;
  const auto levels = level_figures(result.tree, bounding_radius);
  const auto octree = level_figures(result.octree, bounding_radius);
  fmt::print("inaccuracy (how far a sphere reaches from the solid) as a fraction of the bounding radius{}\n",
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
  if (result.medial) print_axis(*result.medial, result.axis_components);
  if (!result.medial && result.points > 0) fmt::print("{} surface points\n", result.points);
  fmt::print("{} redundant spheres removed\n", result.redundancy.removed);
  double total = 0;
  fmt::print("seconds:");
  for (const auto& [stage, seconds] : result.seconds) {
    fmt::print(" {} {:.2f},", stage, seconds);
    total += seconds;
  }
  fmt::print(" in all {:.2f}\n", total);
  if (result.bounds_weakened > 0)
    fmt::print(
        "{} of {} nodes have a bound that could not be proven as tight as it was measured; a weaker one that is proven "
        "is stored\n",
        result.bounds_weakened, result.packed.node_count);
}

}  // namespace orchard::apps
