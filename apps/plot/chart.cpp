#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "svg_plot.h"

// orchard-chart CHARTS.json PICTURE.svg: draws what was measured earlier and kept, so that scripts' plots look as the
// program's. The file has "columns" (plots in a row), and "plots", a list of title, x_label, y_label, log_x, log_y,
// x_names (if x counts them) and "series": name, x, y, dashed, look, of lines. What is not there is empty or false;
// null is a gap.
namespace {

using nlohmann::json;
using orchard::plot::Plot;
using orchard::plot::Series;

std::vector<double> numbers(const json& list) {
  std::vector<double> values;
  values.reserve(list.size());
  for (const json& value : list) values.push_back(value.is_null() ? std::nan("") : value.get<double>());
  return values;
}

Plot plot_of(const json& from) {
  Plot plot{.title = from.value("title", ""),
            .x_label = from.value("x_label", ""),
            .y_label = from.value("y_label", ""),
            .log_x = from.value("log_x", false),
            .log_y = from.value("log_y", false),
            .series = {},
            .levels = {},
            .x_names = from.value("x_names", std::vector<std::string>())};
  for (const json& series : from.at("series")) {
    plot.series.push_back({series.value("name", ""), numbers(series.at("x")), numbers(series.at("y")),
                           Series::Kind::line, series.value("dashed", false)});
    if (series.contains("look")) plot.series.back().look = series.at("look").get<std::size_t>();
  }
  return plot;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: orchard-chart CHARTS.json PICTURE.svg\n", stderr);
    return 2;
  }
  try {
    std::ifstream in(argv[1]);
    const json charts = json::parse(in);
    std::vector<Plot> plots;
    for (const json& plot : charts.at("plots")) plots.push_back(plot_of(plot));
    orchard::plot::write_svg(argv[2], plots, charts.value("columns", 1));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "orchard-chart: %s\n", error.what());
    return 1;
  }
  return 0;
}
