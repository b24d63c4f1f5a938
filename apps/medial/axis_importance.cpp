#include "medial/axis_importance.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "medial/medial_run.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/importance.h"
#include "output/json_values.h"
#include "svg_plot.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr double kDegrees = 180 / std::numbers::pi;
// The parts of the axis' area that the values of a curve remove where the measure alone decides.
constexpr double kParts[] = {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};

// The name of a measure on the command line.
std::string option_name(ImportanceMeasure measure) {
  std::string name = name_of(measure);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

ImportanceMeasure measure_named(const std::string& name) {
  for (const ImportanceMeasure measure : kImportanceMeasures)
    if (name == option_name(measure)) return measure;
  throw InputError("--importance: there is no measure " + name);
}

// The name of the array of a measure.
const char* array_name(ImportanceMeasure measure) {
  switch (measure) {
    case ImportanceMeasure::angle:
      return "contact_angle";
    case ImportanceMeasure::scale:
      return "scale_ratio";
    case ImportanceMeasure::erosion:
      return "erosion_thickness";
    case ImportanceMeasure::geodesic:
      return "medial_geodesic";
    default:
      return name_of(measure);
  }
}

// The area of the faces, and a third of that of the faces around each vertex.
double areas(const MedialMesh& mesh, std::vector<double>& of_vertex) {
  of_vertex.assign(mesh.centers.size(), 0);
  double whole = 0;
  for (const auto& corners : mesh.triangles) {
    const auto& [a, b, c] = corners;
    const double area = 0.5 * (mesh.centers[b] - mesh.centers[a]).cross(mesh.centers[c] - mesh.centers[a]).norm();
    for (const Index corner : corners) of_vertex[corner] += area / 3;
    whole += area;
  }
  return whole;
}

// The values of the measure below which the balls of each part of the area are; each once, and finite ones only.
std::vector<double> values_of_curve(const std::vector<double>& measure, std::vector<double> area_of_vertex) {
  area_of_vertex.resize(measure.size());
  std::vector<Index> order(measure.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return measure[a] < measure[b]; });
  const double whole = std::accumulate(area_of_vertex.begin(), area_of_vertex.end(), 0.0);
  std::vector<double> values;
  double below = 0;
  std::size_t at = 0;
  for (const double part : kParts) {
    while (at + 1 < order.size() && below < part * whole) below += area_of_vertex[order[at++]];
    const double value = measure[order[at]];
    if (std::isfinite(value) && (values.empty() || value > values.back())) values.push_back(value);
  }
  return values;
}

PrunedRow measured_row(const Surface& surface, const MedialAxis& axis, const QualityOptions& options, double whole_area,
                       const Progress& progress) {
  const MedialMesh mesh = medial_mesh(axis);
  const MedialQuality quality = medial_quality(surface, mesh, options, progress);
  std::vector<double> unused;
  return {.vertices = axis.size(),
          .faces = static_cast<Index>(mesh.triangles.size()),
          .area = whole_area > 0 ? areas(mesh, unused) / whole_area : 0,
          .hausdorff_max = 100 * quality.hausdorff.max,
          .hausdorff_mean = 100 * quality.hausdorff.mean,
          .coverage_max = 100 * quality.coverage.max,
          .coverage_mean = 100 * quality.coverage.mean};
}

std::vector<PrunedRow> curve_of(const MedialCommand& command, const Surface& surface, const MedialAxis& axis,
                                const Progress& progress) {
  const ImportanceMeasure measure = measure_named(command.prune_curve);
  const std::vector<double> values = importance(surface, axis, measure, progress);
  std::vector<double> area_of_vertex;
  const double whole = areas(medial_mesh(axis), area_of_vertex);
  QualityOptions options = quality_options(command);
  options.contact_cells = 1;  // what the rows do not tell is not measured
  options.economy_candidates = options.economy_samples = 1;
  const double unit = is_length(measure)                    ? 100 / surface.bounding_box().diagonal().norm()
                      : measure == ImportanceMeasure::angle ? kDegrees
                                                            : 1;
  std::vector<PrunedRow> rows{measured_row(surface, axis, options, whole, progress)};
  rows.front().value = measure == ImportanceMeasure::scale ? 1 : 0;
  for (const double value : values_of_curve(values, std::move(area_of_vertex))) {
    if (!(unit * value > rows.front().value)) continue;
    PrunedRow row = measured_row(surface, prune(surface, axis, measure, values, value), options, whole, progress);
    row.value = unit * value;
    rows.push_back(row);
  }
  return rows;
}

std::string to_csv(const std::vector<PrunedRow>& rows) {
  std::string text = "value,vertices,faces,area,hausdorff_max,hausdorff_mean,coverage_max,coverage_mean\n";
  for (const PrunedRow& row : rows)
    text += fmt::format("{:.6g},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", row.value, row.vertices, row.faces,
                        row.area, row.hausdorff_max, row.hausdorff_mean, row.coverage_max, row.coverage_mean);
  return text;
}

json to_json(const std::vector<PrunedRow>& rows) {
  json result = json::array();
  for (const PrunedRow& row : rows)
    result.push_back({{"value", row.value},
                      {"vertices", row.vertices},
                      {"faces", row.faces},
                      {"area", row.area},
                      {"hausdorff_max", row.hausdorff_max},
                      {"hausdorff_mean", row.hausdorff_mean},
                      {"coverage_max", row.coverage_max},
                      {"coverage_mean", row.coverage_mean}});
  return result;
}

std::string to_svg(const std::vector<PrunedRow>& rows, ImportanceMeasure measure) {
  const std::string x_label = option_name(measure) + (is_length(measure)                    ? ", % of the diagonal"
                                                      : measure == ImportanceMeasure::angle ? ", degrees"
                                                                                            : "");
  plot::Plot error, size;
  error.title = "Two-sided distance of surface and envelope";
  error.x_label = size.x_label = x_label;
  error.y_label = "% of the diagonal";
  size.title = "Size of the axis";
  size.y_label = "% of the unpruned axis";
  const auto add = [&](plot::Plot& plot, const char* name, const auto& value) {
    plot::Series& series = plot.series.emplace_back();
    series.name = name;
    series.kind = plot::Series::Kind::line;
    for (const PrunedRow& row : rows) {
      series.x.push_back(row.value);
      series.y.push_back(value(row));
    }
  };
  add(error, "maximum", [](const PrunedRow& row) { return row.hausdorff_max; });
  add(error, "mean", [](const PrunedRow& row) { return row.hausdorff_mean; });
  add(size, "balls", [&](const PrunedRow& row) { return 100.0 * row.vertices / rows.front().vertices; });
  add(size, "area", [](const PrunedRow& row) { return 100 * row.area; });
  return plot::to_svg({error, size}, 2);
}

void print_curve(const std::vector<PrunedRow>& rows, ImportanceMeasure measure) {
  fmt::print("pruned by {}: distance of surface and envelope, % of the diagonal\n", option_name(measure));
  fmt::print("  {:>10} {:>8} {:>8} {:>10} {:>8} {:>10}\n", "value", "balls", "area, %", "two-sided", "mean",
             "coverage");
  for (const PrunedRow& row : rows)
    fmt::print("  {:>10.4g} {:>8} {:>8.1f} {:>10.3f} {:>8.4f} {:>10.3f}\n", row.value, row.vertices, 100 * row.area,
               row.hausdorff_max, row.hausdorff_mean, row.coverage_max);
}

}  // namespace

std::vector<std::string> importance_names() {
  std::vector<std::string> names = prune_names();
  std::erase(names, "angle");
  return names;
}

std::vector<std::string> prune_names() {
  std::vector<std::string> names;
  names.reserve(kImportanceMeasures.size());
  for (const ImportanceMeasure measure : kImportanceMeasures) names.push_back(option_name(measure));
  return names;
}

void check_importance(const MedialCommand& command) {
  for (const char* option : {"importance", "prune-curve"}) {
    if (!given(command, option)) continue;
    if (!command.axis.empty())
      throw InputError(fmt::format("--{} has no effect with --axis, whose balls have no known contacts", option));
    if (!command.sweep.empty()) throw InputError(fmt::format("--{} has no effect with --sweep", option));
  }
}

std::vector<std::string> importance_file_names(const MedialCommand& command) {
  if (command.prune_curve.empty()) return {};
  const std::string ending = "-prune-" + command.prune_curve;
  return {named(command.mesh, ending + ".csv"), named(command.mesh, ending + ".svg")};
}

AxisImportance measure_importance(const MedialCommand& command, const Surface& surface, const MedialAxis& axis,
                                  const Progress& progress) {
  AxisImportance result;
  for (const std::string& name : command.importance) {
    const ImportanceMeasure measure = measure_named(name);
    time_stage(result.seconds, array_name(measure), [&] {
      std::vector<double> values = importance(surface, axis, measure, progress);
      for (double& value : values)
        if (!std::isfinite(value)) value = std::numeric_limits<double>::quiet_NaN();
      result.arrays.push_back({array_name(measure), std::move(values)});
    });
  }
  if (!command.prune_curve.empty())
    time_stage(result.seconds, "prune curve", [&] { result.curve = curve_of(command, surface, axis, progress); });
  return result;
}

void write_importance(const MedialCommand& command, const AxisImportance& importance, json& report, Outputs& outputs) {
  if (!importance.seconds.empty()) report["importance_seconds"] = seconds_json(importance.seconds);
  if (importance.curve.empty()) return;
  const ImportanceMeasure measure = measure_named(command.prune_curve);
  report["prune_curve"] = {{"measure", option_name(measure)}, {"rows", to_json(importance.curve)}};
  const std::vector<std::string> names = importance_file_names(command);
  write_file(outputs.add(names[0], "values of --prune against the error and the size of the axis"),
             to_csv(importance.curve));
  write_file(outputs.add(names[1], "the same as a picture"), to_svg(importance.curve, measure));
  if (!command.output.quiet && !command.output.json) print_curve(importance.curve, measure);
}

}  // namespace orchard::apps
