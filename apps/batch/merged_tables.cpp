#include "batch/merged_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "command_line/text.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kTightnessBins = 40, kMostMessages = 20;
// The number of points of a plot: more of them are slow to open and hard to distinguish.
constexpr std::size_t kMostPoints = 5000;

ordered_json parsed(const std::string& line) { return ordered_json::parse(line); }

std::string csv_cell(const json& value) {
  if (value.is_null()) return {};
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  return '"' + replaced(text, "\"", "\"\"") + '"';
}

std::string repairs_in_words(const ordered_json& repairs) {
  std::vector<std::string> words;
  for (const auto& [name, count] : repairs.items()) words.push_back(name + "=" + count.dump());
  return joined(words, " ");
}

std::string notes_in_words(const ordered_json& notes) {
  std::vector<std::string> words;
  for (const auto& note : notes) words.push_back(note.get<std::string>());
  return joined(words, "; ");
}

std::vector<std::string> figure_names(const MergedRows& rows) {
  std::vector<std::string> names;
  for (const std::string& line : rows.lines) {
    const ordered_json row = parsed(line);
    for (const auto& [name, value] : row["figures"].items())
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

// Sorts messages of failures by frequency, and equally frequent ones alphabetically.
json by_frequency(const std::map<std::string, std::size_t>& messages) {
  std::vector<std::pair<std::string, std::size_t>> sorted(messages.begin(), messages.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  if (sorted.size() > kMostMessages) sorted.resize(kMostMessages);
  json list = json::array();
  for (const auto& [message, count] : sorted) list.push_back({{"meshes", count}, {"message", message}});
  return list;
}

json tightness_quantiles(std::vector<double> values) {
  if (values.empty()) return nullptr;
  std::sort(values.begin(), values.end());
  const auto at = [&](double part) {
    return values[static_cast<std::size_t>(std::lround(part * static_cast<double>(values.size() - 1)))];
  };
  return {{"meshes", values.size()}, {"min", at(0)}, {"median", at(0.5)}, {"percentile_95", at(0.95)}, {"max", at(1)}};
}

std::vector<double> tightness_of(const MergedRows& rows) {
  std::vector<double> values;
  for (const std::string& line : rows.lines) {
    const ordered_json value = parsed(line)["figures"].value("tightness", ordered_json());
    if (value.is_number()) values.push_back(value);
  }
  return values;
}

plot::Plot tightness_histogram(const std::vector<double>& values) {
  plot::Plot plot;
  plot.title = fmt::format("tightness of {} results", values.size());
  plot.x_label = "tightness";
  plot.y_label = "meshes";
  plot::Series& bars = plot.series.emplace_back();
  bars.kind = plot::Series::Kind::bars;
  const double max = std::max(*std::max_element(values.begin(), values.end()), 1e-12);
  for (std::size_t bin = 0; bin < kTightnessBins; ++bin)
    bars.x.push_back(max * static_cast<double>(bin) / static_cast<double>(kTightnessBins));
  bars.y.assign(kTightnessBins, 0);
  for (const double value : values)
    ++bars.y[std::min(kTightnessBins - 1, static_cast<std::size_t>(value / max * static_cast<double>(kTightnessBins)))];
  return plot;
}

}  // namespace

std::string rows_csv(const MergedRows& rows) {
  const std::vector<std::string> figures = figure_names(rows);
  std::string csv = "index,mesh,key,status,why,exit_code,message,promise_kept,repairs,notes";
  for (const std::string& name : figures) csv += "," + name;
  csv += "\n";
  for (const std::string& line : rows.lines) {
    const ordered_json row = parsed(line);
    std::vector<std::string> cells;
    for (const char* column : {"index", "mesh", "key", "status", "why", "exit_code", "message", "promise_kept"})
      cells.push_back(csv_cell(row[column]));
    cells.push_back(csv_cell(repairs_in_words(row["repairs"])));
    cells.push_back(csv_cell(notes_in_words(row["notes"])));
    for (const std::string& name : figures) cells.push_back(csv_cell(row["figures"].value(name, ordered_json())));
    csv += joined(cells, ",") + "\n";
  }
  return csv;
}

std::string costs_csv(const MergedRows& rows) {
  std::string csv = "index,mesh,seconds,peak_bytes\n";
  for (const std::string& line : rows.costs) {
    const ordered_json row = parsed(line);
    csv += fmt::format("{},{},{},{}\n", csv_cell(row["index"]), csv_cell(row["mesh"]), csv_cell(row["seconds"]),
                       csv_cell(row["peak_bytes"]));
  }
  return csv;
}

json summary_of(const MergedRows& rows) {
  std::map<std::string, std::size_t> statuses{{"solid", 0}, {"repaired", 0}, {"wrapped", 0}, {"failed", 0}};
  std::map<std::string, std::size_t> reasons, messages, repairs;
  std::size_t broken = 0;
  for (const std::string& line : rows.lines) {
    const ordered_json row = parsed(line);
    ++statuses[row["status"]];
    broken += row["promise_kept"] == false ? 1 : 0;
    for (const auto& [name, count] : row["repairs"].items()) ++repairs[name];
    if (row["status"] != "failed") continue;
    ++reasons[row["why"]];
    ++messages[row["message"]];
  }
  return {{"meshes", rows.lines.size()},
          {"statuses", statuses},
          {"failures", reasons},
          {"messages", by_frequency(messages)},
          {"meshes_with_repair", repairs},
          {"promises_not_kept", broken},
          {"tightness", tightness_quantiles(tightness_of(rows))}};
}

std::vector<plot::Plot> plots_of(const MergedRows& rows) {
  std::vector<plot::Plot> plots;
  const std::size_t every = (rows.lines.size() + kMostPoints - 1) / kMostPoints;
  plot::Plot time;
  time.title = every > 1 ? fmt::format("time against size, one of {} meshes", every) : "time against size";
  time.x_label = "triangles";
  time.y_label = "seconds";
  time.log_x = time.log_y = true;
  plot::Series& points = time.series.emplace_back();
  points.kind = plot::Series::Kind::points;
  for (std::size_t i = 0; i < rows.lines.size(); i += every) {
    const ordered_json triangles = parsed(rows.lines[i])["figures"].value("triangles", ordered_json());
    if (!triangles.is_number()) continue;
    points.x.push_back(triangles);
    points.y.push_back(parsed(rows.costs[i]).value("seconds", 0.0));
  }
  if (!points.x.empty()) plots.push_back(time);
  const std::vector<double> tightness = tightness_of(rows);
  if (!tightness.empty()) plots.push_back(tightness_histogram(tightness));
  return plots;
}

}  // namespace orchard::apps
