#include "batch/result_figures.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace orchard::apps {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr double kFromPercent = 0.01;

// The name in the row, and the place in the report.
using FigureNames = std::vector<std::pair<const char*, const char*>>;

void copy(const json& report, const FigureNames& names, ordered_json& figures) {
  for (const auto& [name, place] : names) {
    const json::json_pointer pointer(place);
    if (report.contains(pointer) && report[pointer].is_primitive()) figures[name] = report[pointer];
  }
}

void add_levels(const json& report, ordered_json& figures) {
  const json levels = report.value("levels", json::array());
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const std::string level = "level_" + std::to_string(i) + "_";
    for (const char* figure :
         {"spheres", "mean_inaccuracy_over_radius", "max_inaccuracy_over_radius", "outside_volume_over_solid"})
      if (levels[i].contains(figure)) figures[level + figure] = levels[i][figure];
  }
  if (!levels.empty()) figures["tightness"] = levels.back().value("mean_inaccuracy_over_radius", json());
}

void add_axis(const json& report, ordered_json& figures) {
  if (report.contains("topology"))
    figures["topology_of_solid"] = report["topology"] == report.value("topology_of_solid", json());
  const json open = report.value("/promise/open/upper"_json_pointer, json());
  const json protrusion = report.value("/promise/protrusion/upper"_json_pointer, json());
  if (open.is_number() && protrusion.is_number())
    figures["tightness"] = kFromPercent * std::max(open.get<double>(), protrusion.get<double>());
}

void add_set(const json& report, ordered_json& figures) {
  const double diagonal = report.value("/mesh/diagonal"_json_pointer, 0.0);
  const json distance = report.value("two_sided_mean", json());
  if (distance.is_number() && diagonal > 0) figures["tightness"] = distance.get<double>() / diagonal;
}

}  // namespace

ordered_json figures_of(const json& report, const std::string& command) {
  static const FigureNames kMesh{{"triangles", "/mesh/triangles"},
                                 {"components", "/mesh/components"},
                                 {"diagonal", "/mesh/diagonal"},
                                 {"area", "/mesh/area"},
                                 {"volume", "/mesh/volume"},
                                 {"self_intersections", "/self_intersections"},
                                 {"repair_distance", "/repair/distance"},
                                 {"wrap_distance", "/wrap_distance"}};
  static const FigureNames kTree{{"surface_points", "/surface_points"}, {"conservative", "/conservative"}};
  static const FigureNames kAxis{{"surface_points", "/build/points"},
                                 {"vertices", "/build/vertices"},
                                 {"faces", "/build/faces"},
                                 {"open_percent", "/promise/open/upper"},
                                 {"protrusion_percent", "/promise/protrusion/upper"}};
  static const FigureNames kSet{{"spheres", "/spheres"},
                                {"proven_closed", "/proven_closed"},
                                {"open_share", "/open_share/1"},
                                {"protrusion_over_diagonal", "/protrusion_max_over_diagonal/1"},
                                {"gap_over_diagonal", "/largest_gap_over_diagonal/1"},
                                {"union_over_solid", "/union_over_solid/value"}};
  ordered_json figures = ordered_json::object();
  copy(report, kMesh, figures);
  copy(report, command == "build" ? kTree : command == "medial" ? kAxis : kSet, figures);
  if (command == "build") add_levels(report, figures);
  if (command == "medial") add_axis(report, figures);
  if (command == "spheres") add_set(report, figures);
  return figures;
}

}  // namespace orchard::apps
