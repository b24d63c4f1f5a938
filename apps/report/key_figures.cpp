#include "report/key_figures.h"

#include <map>

namespace orchard::apps {
namespace {

using nlohmann::json;

// Where a figure is in the report. "LAST" stands for the last item of a list.
struct FigurePlace {
  const char* title;
  const char* pointer;
};

const std::map<std::string, std::vector<FigurePlace>>& places() {
  static const std::map<std::string, std::vector<FigurePlace>> all{
      {"build",
       {{"triangles of the mesh", "/mesh/triangles"},
        {"spheres of the deepest level", "/levels/LAST/spheres"},
        {"their mean inaccuracy, in bounding radii", "/levels/LAST/mean_inaccuracy_over_radius"},
        {"volume outside, in volumes of the solid", "/levels/LAST/outside_volume_over_solid"},
        {"seconds", "/seconds"}}},
      {"build_cost", {{"spheres expected", "/spheres"}, {"seconds expected", "/seconds"}}},
      {"medial",
       {{"triangles of the mesh", "/mesh/triangles"},
        {"balls", "/build/vertices"},
        {"balls", "/quality/balls"},
        {"largest two-sided distance, % of the diagonal", "/quality/hausdorff_max"},
        {"mean two-sided distance, % of the diagonal", "/quality/hausdorff_mean"},
        {"length of borders, diagonals", "/quality/border_length"},
        {"balls of the simplified axis", "/simplified/vertices"},
        {"its largest distance, % of the diagonal", "/simplified/hausdorff_max"},
        {"seconds", "/build/seconds/whole"}}},
      {"medial_sweep", {{"measure that the runs are sorted by", "/best_by"}}},
      {"compare", {{"bounding radius, mesh units", "/bounding_radius"}}},
      {"compare_axes", {{"balls at most", "/vertices"}}},
      {"spheres",
       {{"spheres", "/spheres"},
        {"fit", "/fit"},
        {"volume outside, in volumes of the solid", "/outside_over_solid/value"},
        {"volume left out, in volumes of the solid", "/uncovered_over_solid/value"}}},
      {"audit", {{"format", "/format"}, {"spheres", "/sets/0/spheres"}}},
      {"robot", {{"robot", "/robot"}, {"spheres", "/whole/spheres"}, {"seconds", "/seconds"}}},
      {"profile",
       {{"poses", "/poses"},
        {"of them apart", "/separated"},
        {"microseconds to the exact answer, median", "/levels/LAST/microseconds/median"}}},
      {"simulate",
       {{"frames", "/frames"},
        {"bodies", "/bodies"},
        {"answers \"maybe\"", "/maybe"},
        {"microseconds of detection a frame, median", "/microseconds/detection/p50"},
        {"the largest", "/microseconds/detection/max"}}},
      {"thickness",
       {{"least thickness", "/thickness/min"},
        {"median by area", "/thickness/median"},
        {"largest", "/thickness/max"},
        {"area that is thinner than the limit", "/below/area"}}},
      {"leaderboard",
       {{"pairs compared", "/score/pairs"},
        {"orchard is lower in the maximum in", "/score/lower_max"},
        {"in the mean in", "/score/lower_mean"},
        {"its topology is the solid's in", "/score/topology_right"}}},
      {"verify", {{"everything proven", "/ok"}, {"triangles uncovered", "/triangles_uncovered"}}},
      {"collide", {{"answer", "/answer"}}}};
  return all;
}

// Null if there is no such place.
json value_at(const json& report, std::string pointer) {
  if (const std::size_t at = pointer.find("LAST"); at != std::string::npos) {
    const json* list = nullptr;
    if (const json::json_pointer above(pointer.substr(0, at - 1)); report.contains(above)) list = &report[above];
    if (list == nullptr || !list->is_array() || list->empty()) return {};
    pointer.replace(at, 4, std::to_string(list->size() - 1));
  }
  const json::json_pointer place(pointer);
  return report.contains(place) ? report[place] : json();
}

// The sum of times by stage.
json sum_of(const json& value) {
  if (!value.is_object()) return value;
  double sum = 0;
  for (const auto& [stage, time] : value.items()) sum += time.is_number() ? time.get<double>() : 0;
  return sum;
}

}  // namespace

std::vector<KeyFigure> key_figures(const std::string& kind, const json& report) {
  std::vector<KeyFigure> figures;
  const auto at = places().find(kind);
  if (at == places().end()) return figures;
  for (const FigurePlace& place : at->second) {
    json value = sum_of(value_at(report, place.pointer));
    const bool twice = !figures.empty() && figures.back().title == place.title;
    if (!value.is_null() && !twice) figures.push_back({place.title, std::move(value)});
  }
  return figures;
}

}  // namespace orchard::apps
