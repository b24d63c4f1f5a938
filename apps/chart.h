#pragma once
#include <string>
#include <vector>

namespace orchard::apps {

// A line of a chart: one value for each level; values of 0 or less are left out.
struct ChartLine {
  std::string name;
  std::vector<double> values;
};

struct ChartPanel {
  std::string title;
  std::vector<ChartLine> lines;
};

// Panels side by side, levels to the right, values upward on a logarithmic scale, as the text of an SVG file.
std::string chart_svg(const std::string& title, const std::vector<ChartPanel>& panels);

}  // namespace orchard::apps
