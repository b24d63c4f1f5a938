#include "report/sweep_plots.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace orchard::apps {
namespace {

using nlohmann::json;
using plot::Plot;
using plot::Series;

struct Measure {
  std::string key, label;
};

const std::vector<Measure> kCosts{
    {"balls", "balls"}, {"border_length", "length of borders, diagonals"}, {"seconds", "seconds to build"}};

double value_in(const json& run, const std::string& key) {
  const auto at = run.find(key);
  return at == run.end() || !at->is_number() ? std::nan("") : at->get<double>();
}

bool varies(const json& runs, const std::string& key) {
  std::vector<double> values;
  for (const json& run : runs)
    if (const double value = value_in(run, key); std::isfinite(value)) values.push_back(value);
  return !values.empty() &&
         *std::max_element(values.begin(), values.end()) > *std::min_element(values.begin(), values.end());
}

// What the runs are rated by: distances, the measure that they are sorted by, and a tree's deepest level.
std::vector<Measure> gains_of(const json& report) {
  std::vector<Measure> gains{{"hausdorff_max", "largest distance, % of the diagonal"},
                             {"hausdorff_mean", "mean distance, % of the diagonal"}};
  const std::string best = report.at("best_by");
  const auto is = [](const std::string& key) { return [&key](const Measure& one) { return one.key == key; }; };
  if (std::none_of(gains.begin(), gains.end(), is(best)) && std::none_of(kCosts.begin(), kCosts.end(), is(best)))
    gains.push_back({best, best});
  std::string deepest;
  for (const auto& [key, value] : report.at("runs").front().items())
    if (key.starts_with("level_") && key.ends_with("_mean") && key >= deepest) deepest = key;
  if (!deepest.empty() && deepest != best)
    gains.push_back({deepest, "tree: mean inaccuracy of the deepest level, bounding radii"});
  return gains;
}

Plot trade_off(const json& report, const Measure& cost, const Measure& gain) {
  Plot plot;
  plot.title = gain.label + " against " + cost.label.substr(0, cost.label.find(','));
  plot.x_label = cost.label;
  plot.y_label = gain.label;
  plot.log_y_if_wide = true;
  plot.log_x = cost.key == "balls";
  struct Place {
    double x, y;
    std::string label;
  };
  std::map<std::string, std::vector<Place>> lines;
  const json& swept = report.at("swept");
  for (const json& run : report.at("runs")) {
    std::string name;
    for (std::size_t i = 1; i < swept.size(); ++i) {
      const std::string option = swept.at(i);
      name += (i > 1 ? ", " : "") + option + ' ' + run.at(option).get<std::string>();
    }
    const std::string first = swept.at(0);
    lines[name].push_back({value_in(run, cost.key), value_in(run, gain.key), run.at(first).get<std::string>()});
  }
  for (auto& [name, places] : lines) {
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.x < b.x; });
    Series& series = plot.series.emplace_back();
    series.name = name;
    series.kind = Series::Kind::line;
    for (const Place& place : places) {
      series.x.push_back(place.x);
      series.y.push_back(place.y);
      series.labels.push_back(place.label);
    }
  }
  return plot;
}

}  // namespace

std::vector<Plot> trade_off_plots(const json& report) {
  std::vector<Plot> plots;
  const json& runs = report.at("runs");
  if (runs.size() < 2) return plots;
  for (const Measure& gain : gains_of(report))
    for (const Measure& cost : kCosts)
      if (cost.key != gain.key && varies(runs, cost.key) && varies(runs, gain.key))
        plots.push_back(trade_off(report, cost, gain));
  return plots;
}

}  // namespace orchard::apps
