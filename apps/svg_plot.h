#pragma once
#include <string>
#include <utility>
#include <vector>

namespace orchard::apps {

struct PlotSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;  // in order of x
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<PlotSeries> series;
  std::vector<std::string> x_names;  // not empty: x counts these
  bool log_x = false;                // where all x are positive
};

// A line chart as SVG. Values that are not finite leave a gap.
std::string to_svg(const Plot& plot);

}  // namespace orchard::apps
