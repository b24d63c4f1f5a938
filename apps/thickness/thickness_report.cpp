#include "thickness/thickness_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "input/reading_report.h"
#include "output/json_values.h"
#include "svg_plot.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr std::size_t kPrinted = 10;  // regions that the table has; the report has all

// The least, the area-weighted quantiles and the largest of the values that are defined.
struct Summary {
  double min = NAN, tenth = NAN, median = NAN, max = NAN;
  double max_error = 0;       // of the decided places
  double undecided_area = 0;  // where the search ended before it was known whether there is a thickness
};

Summary summary_of(const LocalThickness& thickness) {
  const TriangleMesh& mesh = thickness.mesh;
  const std::vector<double>& values = thickness.at_triangles.thickness;
  std::vector<std::pair<double, double>> sorted;  // value, area
  double total = 0;
  Summary summary;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const double area = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm() / 2;
    const double error = thickness.at_triangles.error[i];
    if (std::isinf(error))
      summary.undecided_area += area;
    else
      summary.max_error = std::max(summary.max_error, error);
    if (std::isnan(values[i])) continue;
    sorted.emplace_back(values[i], area);
    total += area;
  }
  if (sorted.empty()) return summary;
  std::sort(sorted.begin(), sorted.end());
  summary.min = sorted.front().first;
  summary.max = sorted.back().first;
  double below = 0;
  for (const auto& [value, area] : sorted) {
    below += area;
    if (std::isnan(summary.tenth) && below >= 0.1 * total) summary.tenth = value;
    if (std::isnan(summary.median) && below >= 0.5 * total) summary.median = value;
  }
  return summary;
}

json number(double value) { return std::isnan(value) ? json() : json(value); }

const char* name_of(ThicknessDefinition definition) { return definition == ThicknessDefinition::ray ? "ray" : "ball"; }

// Without what conversion there and back adds: 120, not 119.99999999999999.
double degrees(double radians) { return std::round(radians * 180 / std::numbers::pi * 1e9) / 1e9; }

}  // namespace

json to_json(const ThicknessReport& report) {
  const Summary summary = summary_of(report.thickness);
  json result{{"definition", name_of(report.options.definition)},
              {"unit", report.unit.empty() ? json() : json(report.unit)},
              {"facing_degrees", degrees(report.options.facing)},
              {"smooth_degrees", degrees(report.options.smooth)},
              {"vertices", report.thickness.mesh.vertices.size()},
              {"triangles", report.thickness.mesh.triangles.size()},
              {"area", report.thin.total_area},
              {"defined_area", report.thin.defined_area},
              {"undecided_area", summary.undecided_area},
              {"thickness",
               {{"min", number(summary.min)},
                {"percentile10", number(summary.tenth)},
                {"median", number(summary.median)},
                {"max", number(summary.max)}}},
              {"max_error", summary.max_error}};
  result["histogram"] = {{"bin_width", report.histogram.bin_width},
                         {"thickness_area", report.histogram.thickness},
                         {"ball_diameter_area", report.histogram.ball_diameter}};
  if (!report.below) return result;
  json regions = json::array();
  for (const ThinRegion& region : report.thin.regions)
    regions.push_back({{"area", region.area},
                       {"min_thickness", region.min_thickness},
                       {"thinnest", point_json(region.thinnest)},
                       {"box", {point_json(region.box.min()), point_json(region.box.max())}},
                       {"triangles", region.triangles}});
  result["below"] = {{"limit", *report.below}, {"area", report.thin.area}, {"regions", std::move(regions)}};
  return result;
}

void print(const ThicknessReport& report) {
  const std::string unit = with_unit(report.unit);
  const Summary summary = summary_of(report.thickness);
  fmt::print("thickness by {}s at {} triangles and {} vertices, defined on {:.1f} % of the area:\n",
             name_of(report.options.definition), report.thickness.mesh.triangles.size(),
             report.thickness.mesh.vertices.size(), 100 * report.thin.defined_area / report.thin.total_area);
  fmt::print("        least   10 % of area         median        largest\n{:13.6g} {:14.6g} {:14.6g} {:14.6g}{}\n",
             summary.min, summary.tenth, summary.median, summary.max, unit);
  if (summary.max_error > 0)
    fmt::print("diameters are proven to be too large by at most {:.3g}{}\n", summary.max_error, unit);
  if (summary.undecided_area > 0)
    fmt::print("on {:.3g} % of the area the search ended before it was known whether there is a thickness\n",
               100 * summary.undecided_area / report.thin.total_area);
  if (!report.below) return;
  const auto& regions = report.thin.regions;
  if (regions.empty()) {
    fmt::print("nowhere thinner than {:g}{}\n", *report.below, unit);
    return;
  }
  fmt::print("thinner than {:g}{}: {:.3g} % of the area, in {} region{}\n", *report.below, unit,
             100 * report.thin.area / report.thin.total_area, regions.size(), regions.size() == 1 ? "" : "s");
  fmt::print("         area          least   where it is thinnest\n");
  for (std::size_t i = 0; i < std::min(regions.size(), kPrinted); ++i) {
    const Point& at = regions[i].thinnest;
    fmt::print("{:13.6g} {:14.6g}   {:.6g} {:.6g} {:.6g}\n", regions[i].area, regions[i].min_thickness, at.x(), at.y(),
               at.z());
  }
  if (regions.size() > kPrinted) fmt::print("and {} more, which the report has\n", regions.size() - kPrinted);
}

std::string to_csv(const ThicknessReport& report) {
  std::string text = "from,to,thickness_area,ball_diameter_area\n";
  const ThicknessHistogram& histogram = report.histogram;
  for (std::size_t i = 0; i < histogram.thickness.size(); ++i)
    text += fmt::format("{},{},{},{}\n", histogram.bin_width * static_cast<double>(i),
                        histogram.bin_width * static_cast<double>(i + 1), histogram.thickness[i],
                        histogram.ball_diameter[i]);
  return text;
}

void write_plot(const std::filesystem::path& svg, const ThicknessReport& report) {
  const ThicknessHistogram& histogram = report.histogram;
  const std::string unit = report.unit.empty() ? "mesh units" : report.unit;
  plot::Series bars{.name = {}, .x = {}, .y = {}, .kind = plot::Series::Kind::bars};
  for (std::size_t i = 0; i < histogram.thickness.size(); ++i) {
    bars.x.push_back(histogram.bin_width * static_cast<double>(i));
    bars.y.push_back(100 * histogram.thickness[i] / report.thin.total_area);
  }
  plot::Plot picture;
  picture.title = "Thickness";
  picture.x_label = "thickness, " + unit;
  picture.y_label = "% of the area";
  picture.series.push_back(std::move(bars));
  plot::write_svg(svg, {picture});
}

}  // namespace orchard::apps
