#include "medial/medial_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr const char* kNotDefined = "not defined";
constexpr double kLoose = 2;          // times what was found: a proven bound above that says little
constexpr double kNegligible = 0.01;  // % of the diagonal: bounds below that are good enough in any case
constexpr std::size_t kNarrowest = 12, kWidest = 28;  // of a column

// Long names are cut at the beginning, because their ends distinguish files.
std::string fitted(const std::string& name) {
  return name.size() <= kWidest ? name : ".." + name.substr(name.size() - kWidest + 2);
}

std::string cell(double value, const MedialMeasure& measure) {
  if (std::isnan(value)) return kNotDefined;
  return *measure.unit == '\0' ? fmt::format("{:.0f}", value) : fmt::format("{:.5f}", value);
}

// One line such as "1 0 0 right" replaces four rows.
void print_topologies(const std::vector<JudgedAxis>& axes, const std::vector<std::size_t>& widths) {
  const auto three = [](const Topology& t) { return fmt::format("{} {} {}", t.components, t.loops, t.cavities); };
  fmt::print("  {:<30}", "components, loops, cavities");
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const MedialQuality& quality = axes[i].judgement.quality;
    fmt::print(" {:>{}}", three(quality.found) + (quality.found == quality.wanted ? " right" : " WRONG"), widths[i]);
  }
  fmt::print("  the solid has {}\n", three(axes.front().judgement.quality.wanted));
}

// A proven bound and what was found, as fractions of the diagonal.
struct Bound {
  const char* of;
  double found, upper;
};

// For proven bounds that are far above the measured values, prints why, because readers would otherwise take them for
// the error.
void print_loose_bounds(const JudgedAxis& axis) {
  const MedialQuality& quality = axis.judgement.quality;
  const double reach = std::max(quality.protrusion.max, quality.coverage.max);
  for (const Bound& bound : {Bound{"coverage error", quality.coverage.max, quality.coverage_upper},
                             Bound{"protrusion", quality.protrusion.max, quality.protrusion_upper},
                             Bound{"dents", std::max(reach, quality.hausdorff.max), quality.dent_upper}}) {
    if (100 * bound.upper <= std::max(kLoose * 100 * bound.found, kNegligible)) continue;
    fmt::print("  {}: the bound on {} is {:.3g} times what was found; the search ended before it could prove less{}\n",
               fitted(axis.name), bound.of, bound.found > 0 ? bound.upper / bound.found : INFINITY,
               std::string_view(bound.of) == "protrusion" ? ", or a ball closes a crevice" : "");
  }
}

}  // namespace

const char* measure_name(WorstKind kind) {
  switch (kind) {
    case WorstKind::protrusion:
      return "protrusion";
    case WorstKind::coverage:
      return "coverage";
    case WorstKind::dent:
      break;
  }
  return "dent";
}

json to_json(const MedialJudgement& judgement) {
  json values = json::object();
  for (const MedialMeasure& measure : medial_measures()) {
    const double value = measure.get(judgement);
    if (std::isnan(value)) {
      values[measure.name] = json();
    } else if (*measure.unit == '\0') {
      values[measure.name] = static_cast<std::int64_t>(value);
    } else {
      values[measure.name] = value;
    }
  }
  return values;
}

void print_table(const std::vector<JudgedAxis>& axes, const std::vector<std::string>& promised) {
  std::vector<std::size_t> widths;
  fmt::print("{:<32}", "quality");
  for (const JudgedAxis& axis : axes) {
    widths.push_back(std::clamp(axis.name.size(), kNarrowest, kWidest));
    fmt::print(" {:>{}}", fitted(axis.name), widths.back());
  }
  fmt::print("\n");
  for (const MedialMeasure& measure : medial_measures()) {
    const std::string name = measure.name;
    if (name == "topology_right") print_topologies(axes, widths);
    if (name == "topology_right" || name == "components" || name == "loops" || name == "cavities") continue;
    const bool defined = std::any_of(axes.begin(), axes.end(),
                                     [&](const JudgedAxis& axis) { return !std::isnan(measure.get(axis.judgement)); });
    if (!defined && std::find(promised.begin(), promised.end(), name) == promised.end()) continue;
    fmt::print("  {:<30}", measure.title);
    for (std::size_t i = 0; i < axes.size(); ++i)
      fmt::print(" {:>{}}", cell(measure.get(axes[i].judgement), measure), widths[i]);
    fmt::print("{}{}\n", *measure.unit == '\0' ? "" : "  ", measure.unit);
  }
  for (const JudgedAxis& axis : axes) print_loose_bounds(axis);
}

json to_json(const std::vector<ReportedPlace>& places) {
  json rows = json::array();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const WorstPlace& place = places[i].place;
    rows.push_back({{"number", i + 1},
                    {"measure", measure_name(place.kind)},
                    {"value", 100 * place.value},
                    {"position", {place.position.x(), place.position.y(), place.position.z()}},
                    {"advice", places[i].advice}});
  }
  return rows;
}

void print(const std::vector<ReportedPlace>& places) {
  if (places.empty()) return;
  fmt::print("worst places  measure      % of the diagonal  at\n");
  for (std::size_t i = 0; i < places.size(); ++i) {
    const WorstPlace& place = places[i].place;
    fmt::print("  {:>10}  {:<11} {:>18.5f}  {:.6g} {:.6g} {:.6g}: {}\n", i + 1, measure_name(place.kind),
               100 * place.value, place.position.x(), place.position.y(), place.position.z(), places[i].advice);
  }
}

}  // namespace orchard::apps
