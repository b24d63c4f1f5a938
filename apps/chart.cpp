#include "chart.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace orchard::apps {
namespace {

constexpr double kPanelWidth = 330, kPanelHeight = 300, kLeft = 62, kTop = 70, kBottom = 40, kGap = 24;
constexpr double kLegendRow = 18;
const std::vector<std::string> kColors{"#1b6ca8", "#c8553d", "#3c8d53", "#8a5aa8", "#b0882a", "#4c4c4c", "#d1729f"};

std::string escape(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  return result;
}

struct Axes {
  double x, low, high;  // left edge; decades
  std::size_t levels;
  double at_level(std::size_t level) const {
    const double span = kPanelWidth - kLeft - 12;
    return x + kLeft + (levels < 2 ? 0.5 : static_cast<double>(level) / static_cast<double>(levels - 1)) * span;
  }
  double at_value(double value) const {
    return kTop + (high - std::log10(value)) / (high - low) * (kPanelHeight - kBottom);
  }
};

std::string draw_axes(const ChartPanel& panel, const Axes& axes) {
  std::string text = fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\">{}</text>\n", axes.x + kLeft,
                                 kTop - 14, escape(panel.title));
  for (double decade = axes.low; decade <= axes.high + 0.5; ++decade) {
    const double y = axes.at_value(std::pow(10.0, decade));
    text += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#ddd\"/>\n",
                        axes.x + kLeft, y, axes.x + kPanelWidth, y);
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{:g}</text>\n", axes.x + kLeft - 6, y + 4,
                        std::pow(10.0, decade));
  }
  for (std::size_t level = 0; level < axes.levels; ++level)
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", axes.at_level(level),
                        kTop + kPanelHeight - kBottom + 20, level == 0 ? "level 0" : std::to_string(level));
  return text;
}

std::string draw_line(const ChartLine& line, const Axes& axes, const std::string& color) {
  std::string path, dots;
  for (std::size_t level = 0; level < line.values.size(); ++level) {
    if (!(line.values[level] > 0)) continue;
    const double x = axes.at_level(level), y = axes.at_value(line.values[level]);
    path += fmt::format("{}{:.1f},{:.1f} ", path.empty() ? "M" : "L", x, y);
    dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x, y, color);
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n{}", path, color, dots);
}

}  // namespace

std::string chart_svg(const std::string& title, const std::vector<ChartPanel>& panels) {
  std::size_t names = 0;
  for (const ChartPanel& panel : panels) names = std::max(names, panel.lines.size());
  const double width = static_cast<double>(panels.size()) * (kPanelWidth + kGap);
  const double height = kTop + kPanelHeight + kLegendRow * static_cast<double>(names) + 16;
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n<text x=\"{2:.0f}\" y=\"28\" font-size=\"16\">{3}</text>\n",
      width, height, kLeft, escape(title));
  for (std::size_t p = 0; p < panels.size(); ++p) {
    double low = 1e300, high = -1e300;
    std::size_t levels = 0;
    for (const ChartLine& line : panels[p].lines) {
      levels = std::max(levels, line.values.size());
      for (const double value : line.values)
        if (value > 0) low = std::min(low, std::log10(value)), high = std::max(high, std::log10(value));
    }
    if (low > high) low = high = 0;
    low = std::floor(low);
    const Axes axes{static_cast<double>(p) * (kPanelWidth + kGap), low, std::max(low + 1, std::ceil(high)), levels};
    text += draw_axes(panels[p], axes);
    for (std::size_t i = 0; i < panels[p].lines.size(); ++i)
      text += draw_line(panels[p].lines[i], axes, kColors[i % kColors.size()]);
  }
  for (std::size_t i = 0; !panels.empty() && i < panels[0].lines.size(); ++i) {
    const double y = kTop + kPanelHeight + kLegendRow * static_cast<double>(i);
    text += fmt::format("<rect x=\"{:.0f}\" y=\"{:.1f}\" width=\"14\" height=\"4\" fill=\"{}\"/>\n", kLeft, y - 6,
                        kColors[i % kColors.size()]);
    text += fmt::format("<text x=\"{:.0f}\" y=\"{:.1f}\">{}</text>\n", kLeft + 22, y, escape(panels[0].lines[i].name));
  }
  return text + "</svg>\n";
}

}  // namespace orchard::apps
