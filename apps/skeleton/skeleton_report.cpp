#include "skeleton/skeleton_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "medial/medial_report.h"
#include "medial/medial_warning.h"
#include "output/json_values.h"
#include "output/report.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr std::size_t kPrintedCurves = 10;  // that the table has; the report has all

struct SkeletonCounts {
  std::size_t ends = 0, branchings = 0, points = 0;
  double length = 0, sheet_area = 0, min_radius = 0, max_radius = 0;
};

SkeletonCounts counts_of(const CurveSkeleton& skeleton) {
  SkeletonCounts counts;
  std::vector<std::size_t> degrees(skeleton.vertices.size(), 0);
  for (const CurveSkeleton::Arc& arc : skeleton.arcs) {
    ++degrees[arc.from];
    ++degrees[arc.to];
    counts.length += arc.length;
  }
  for (const Index node : skeleton.nodes) {
    counts.points += degrees[node] == 0 ? 1 : 0;
    counts.ends += degrees[node] == 1 ? 1 : 0;
    counts.branchings += degrees[node] > 2 ? 1 : 0;
  }
  for (const auto& [a, b, c] : skeleton.sheets) {
    const auto& at = skeleton.vertices;
    counts.sheet_area += (at[b] - at[a]).cross(at[c] - at[a]).norm() / 2;
  }
  const auto [least, largest] = std::minmax_element(skeleton.radii.begin(), skeleton.radii.end());
  if (least != skeleton.radii.end()) counts.min_radius = *least, counts.max_radius = *largest;
  return counts;
}

json curves_json(const CurveSkeleton& skeleton) {
  json curves = json::array();
  for (const CurveSkeleton::Arc& arc : skeleton.arcs)
    curves.push_back({{"from", point_json(skeleton.vertices[arc.from])},
                      {"to", point_json(skeleton.vertices[arc.to])},
                      {"length", arc.length},
                      {"min_radius", arc.min_radius},
                      {"mean_radius", arc.mean_radius},
                      {"significance", std::isfinite(arc.significance) ? json(arc.significance) : json()},
                      {"is_curve_of_axis", arc.of_axis}});
  return curves;
}

// The longest first.
std::vector<const CurveSkeleton::Arc*> longest_arcs(const CurveSkeleton& skeleton) {
  std::vector<const CurveSkeleton::Arc*> arcs;
  for (const CurveSkeleton::Arc& arc : skeleton.arcs) arcs.push_back(&arc);
  std::stable_sort(arcs.begin(), arcs.end(), [](const auto* a, const auto* b) { return a->length > b->length; });
  return arcs;
}

}  // namespace

Broken broken(const SkeletonReport& report) {
  Broken result;
  if (report.found == report.axis.wanted) return result;
  result.what.push_back(
      fmt::format("the skeleton has {}, the solid {}", in_words(report.found), in_words(report.axis.wanted)));
  result.remedy = topology_remedy(report.command.axis, report.axis);
  return result;
}

json to_json(const SkeletonReport& report) {
  const CurveSkeleton& skeleton = report.skeleton;
  const SkeletonOptions& options = report.command.options;
  const SkeletonCounts counts = counts_of(skeleton);
  const Broken promise = broken(report);
  return {{"mesh", mesh_json(report.axis.solid.surface)},
          {"side", report.command.axis.outside ? "outside" : "inside"},
          {"erosion_over_diagonal", options.erosion},
          {"ratio", options.ratio},
          {"vertices", skeleton.vertices.size()},
          {"edges", skeleton.edges.size()},
          {"length", counts.length},
          {"min_radius", counts.min_radius},
          {"max_radius", counts.max_radius},
          {"ends", counts.ends},
          {"branchings", counts.branchings},
          {"points", counts.points},
          {"curves", curves_json(skeleton)},
          {"closed_sheets", {{"triangles", skeleton.sheets.size()}, {"area", counts.sheet_area}}},
          {"edge_length", skeleton.edge_length},
          {"moved_at_most", skeleton.max_moved},
          {"distance_from_axis_at_most", skeleton.axis_distance},
          {"edges_left_out_of_swc", left_out_of_swc(skeleton).size()},
          {"topology", to_json(report.found)},
          {"topology_of_solid", to_json(report.axis.wanted)},
          {"promise", {{"kept", promise.none()}, {"broken", promise.what}}},
          {"axis", axis_json(report.command.axis, report.axis)}};
}

void print(const SkeletonReport& report) {
  const CurveSkeleton& skeleton = report.skeleton;
  const SkeletonCounts counts = counts_of(skeleton);
  const double diagonal = report.axis.solid.surface.bounding_box().diagonal().norm();
  fmt::print("skeleton: {} curves, {:.6g} long, with {} ends and {} branchings", skeleton.arcs.size(), counts.length,
             counts.ends, counts.branchings);
  if (counts.points > 0) fmt::print(", {} single points", counts.points);
  fmt::print("; radii {:.6g} to {:.6g}\n", counts.min_radius, counts.max_radius);
  if (!skeleton.sheets.empty())
    fmt::print("{} triangles of closed sheets around cavities stay, area {:.6g}: no curve can replace them\n",
               skeleton.sheets.size(), counts.sheet_area);
  fmt::print("it has {}; the solid {}\n", in_words(report.found), in_words(report.axis.wanted));
  fmt::print("straightened by {:.3g} at most ({:.3g} % of the diagonal); proven to be within {:.3g} of the axis\n",
             skeleton.max_moved, 100 * skeleton.max_moved / diagonal, skeleton.axis_distance);
  if (const std::size_t cut = left_out_of_swc(skeleton).size(); cut > 0)
    fmt::print("{} edges are left out of the SWC file, which holds no loops\n", cut);
  if (skeleton.arcs.empty()) return;
  const auto arcs = longest_arcs(skeleton);
  fmt::print("       length   min radius  mean radius   significance   from .. to\n");
  for (std::size_t i = 0; i < std::min(arcs.size(), kPrintedCurves); ++i) {
    const Point &a = skeleton.vertices[arcs[i]->from], &b = skeleton.vertices[arcs[i]->to];
    const std::string significance =
        std::isfinite(arcs[i]->significance) ? fmt::format("{:.6g}", arcs[i]->significance) : "loop";
    fmt::print("{:13.6g} {:12.6g} {:12.6g} {:>14}   {:.4g} {:.4g} {:.4g} .. {:.4g} {:.4g} {:.4g}\n", arcs[i]->length,
               arcs[i]->min_radius, arcs[i]->mean_radius, significance, a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
  }
  if (arcs.size() > kPrintedCurves) fmt::print("and {} more, which the report has\n", arcs.size() - kPrintedCurves);
}

}  // namespace orchard::apps
