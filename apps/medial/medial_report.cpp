#include "medial/medial_report.h"

#include <fmt/core.h>

#include <algorithm>

#include "output/json_values.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

json gap_repair_json(const GapRepairReport& repair) {
  json passes = json::array();
  for (const GapRepairPass& pass : repair.passes) {
    passes.push_back({{"cells_tested", pass.cells_tested},
                      {"cells_crossing", pass.cells_crossing},
                      {"faces_tested", pass.faces_tested},
                      {"faces_crossing", pass.faces_crossing},
                      {"added_by_projection", pass.added_by_projection},
                      {"added_by_snapping", pass.added_by_snapping},
                      {"added_at_necks", pass.added_at_necks},
                      {"refused_as_coincident", pass.refused_as_coincident}});
  }
  return {{"passes", passes},
          {"points_added", repair.points_added},
          {"points_removed", repair.points_removed},
          {"faces_still_crossing", repair.faces_still_crossing},
          {"faces_at_cuts", repair.faces_at_cuts}};
}

}  // namespace

json to_json(const Topology& topology) {
  return {{"components", topology.components},
          {"loops", topology.loops},
          {"cavities", topology.cavities},
          {"euler_characteristic", topology.euler_characteristic()}};
}

json refinement_json(const RefineReport& report) {
  return {{"vertices_before", report.vertices_before},
          {"inexact_vertices", report.inexact},
          {"single_contact_triangles", report.single_contact_triangles},
          {"border_cuts", report.border_cuts},
          {"spike_and_flake_cells_removed", report.small_pieces},
          {"vertices_moved", report.vertices_moved},
          {"filling_triangles", report.filling_triangles},
          {"open_places_reached", report.reached_places},
          {"vertices_on_sharp_edges", report.edge_vertices},
          {"degenerate_cells_removed", report.degenerate},
          {"edges_divided", report.divided},
          {"edges_beyond_tolerance", report.undivided},
          {"border_length", report.border_length}};
}

json to_json(const MedialBuild& build) {
  json seconds = seconds_json(build.seconds);
  double whole = 0;
  for (const auto& [stage, time] : build.seconds) whole += time;
  seconds["whole"] = whole;
  const double points = std::max<double>(build.points, 1);
  const double gained = static_cast<double>(build.sampling.size()) - build.points;
  return {{"points", build.points},
          {"points_added_over_points", gained / points},
          {"gap_repair", gap_repair_json(build.gap_repair)},
          {"voronoi_vertices", build.diagram.vertices.size()},
          {"vertices_before_pruning", build.unpruned_vertices},
          {"open_places", build.open_places},
          {"refinement", build.refinement.vertices > 0 ? refinement_json(build.refinement) : json()},
          {"feature_edges", build.features.size()},
          {"vertices_on_stems", build.axis.stems},
          {"bridges", build.axis.bridges},
          {"vertices_left_out", build.axis.left_out},
          {"vertices", build.axis.size()},
          {"faces", build.axis.faces.size()},
          {"topology_faces", build.axis.topology_faces.size()},
          {"seconds", seconds}};
}

json to_json(const MedialSegments& segments, const StructureGraph& graph, const MedialStructure& structure) {
  json parts = json::array();
  for (const MedialStructure::Part& part : structure.parts) {
    parts.push_back({{"kind", name_of(part.kind)}, {"cells", part.cells}, {"vertices", part.vertices.size()}});
  }
  json rows = json::array();
  for (const MedialSegments::Segment& s : segments.segments) {
    rows.push_back({{"has_faces", s.has_faces},
                    {"trunk", s.trunk},
                    {"cells", s.cells},
                    {"min_radius", s.min_radius},
                    {"max_radius", s.max_radius}});
  }
  return {{"segments", rows}, {"graph_nodes", graph.nodes.size()}, {"graph_arcs", graph.arcs.size()}, {"parts", parts}};
}

void print(const MedialStructure& structure) {
  const auto counted = [&](StructureKind kind, const char* plural) {
    const std::size_t n = structure.count(kind);
    return fmt::format("{} {}", n, n == 1 ? name_of(kind) : plural);
  };
  fmt::print("{}, {}, {}, {}, {}\n", counted(StructureKind::sheet, "sheets"), counted(StructureKind::seam, "seams"),
             counted(StructureKind::border, "borders"), counted(StructureKind::curve, "curves"),
             counted(StructureKind::junction, "junctions"));
}

void print(const MedialBuild& build) {
  for (const auto& [stage, time] : build.seconds) fmt::print("  {:<18} {:>8.2f} s\n", stage, time);
  const GapRepairReport& repair = build.gap_repair;
  if (!repair.passes.empty()) {
    fmt::print("gap repair  pass  cells tested  crossing  faces crossing  projected  snapped  at necks  refused\n");
    for (std::size_t i = 0; i < repair.passes.size(); ++i) {
      const GapRepairPass& pass = repair.passes[i];
      fmt::print("{:>16} {:>13} {:>9} {:>15} {:>10} {:>8} {:>9} {:>8}\n", i + 1, pass.cells_tested, pass.cells_crossing,
                 pass.faces_crossing, pass.added_by_projection, pass.added_by_snapping, pass.added_at_necks,
                 pass.refused_as_coincident);
    }
  }
  const double gained = static_cast<double>(build.sampling.size()) - build.points;
  fmt::print("{} + {}", build.points, repair.points_added);
  if (repair.points_removed > 0) fmt::print(" - {}", repair.points_removed);
  if (build.open_places > 0) fmt::print(" + {} at open places", build.open_places);
  fmt::print(" points ({:.1f} % added), {} faces still crossing", 100.0 * gained / std::max<double>(build.points, 1),
             repair.faces_still_crossing);
  if (repair.faces_at_cuts > 0) fmt::print(", {} of them where the mesh cuts itself", repair.faces_at_cuts);
  const RefineReport& refinement = build.refinement;
  fmt::print("\n{} medial vertices", build.axis.size());
  if (build.axis.size() != build.unpruned_vertices) fmt::print(" after pruning, {} before", build.unpruned_vertices);
  if (refinement.vertices > 0)
    fmt::print(", refined from {}: {} inexact, {} on sharp edges", refinement.vertices_before, refinement.inexact,
               refinement.edge_vertices);
  if (build.axis.stems > 0) fmt::print(", {} without faces", build.axis.stems);
  if (build.axis.bridges > 0) fmt::print(", {} edges that bridge the outside", build.axis.bridges);
  if (build.axis.left_out > 0) fmt::print(", {} left out", build.axis.left_out);
  fmt::print(", {} faces\n", build.axis.faces.size());
  if (refinement.vertices == 0) return;
  fmt::print(
      "refining: {} triangles with a single contact and what borders lose less than cut off, {} cells of spikes and "
      "flakes taken "
      "away, {} triangles filled in, {} open places reached, {} edges divided",
      refinement.single_contact_triangles, refinement.small_pieces, refinement.filling_triangles,
      refinement.reached_places, refinement.divided);
  if (refinement.undivided > 0) fmt::print(", {} still beyond the tolerance", refinement.undivided);
  fmt::print("; borders {:.1f} diagonals long\n", refinement.border_length);
}

}  // namespace orchard::apps
