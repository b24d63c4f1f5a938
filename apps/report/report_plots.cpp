#include "report/report_plots.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "report/sweep_plots.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
using plot::Plot;
using plot::Series;

constexpr const char* kOverRadius = "bounding radii";

double number_at(const json& object, const char* key) {
  const auto at = object.find(key);
  return at == object.end() || !at->is_number() ? std::nan("") : at->get<double>();
}

Plot titled(const std::string& title, const std::string& x_label, const std::string& y_label, bool log_y) {
  Plot plot;
  plot.title = title;
  plot.x_label = x_label;
  plot.y_label = y_label;
  plot.log_y = log_y;
  return plot;
}

Series line_named(const std::string& name, bool dashed = false) {
  Series series;
  series.name = name;
  series.kind = Series::Kind::line;
  series.dashed = dashed;
  return series;
}

// A key of the items of a list against their numbers.
void add_levels(Plot& plot, const std::string& name, const json& levels, const char* key, bool dashed = false) {
  Series series = line_named(name, dashed);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (i >= plot.x_names.size()) plot.x_names.push_back(std::to_string(i));
    series.x.push_back(static_cast<double>(i));
    series.y.push_back(number_at(levels[i], key));
  }
  plot.series.push_back(std::move(series));
}

// Bars from 0 on, each `width` wide.
Plot bars_of(const std::string& title, const std::string& x_label, const std::string& y_label, const json& counts,
             double width) {
  Plot plot = titled(title, x_label, y_label, false);
  Series series;
  series.kind = Series::Kind::bars;
  for (const json& count : counts) {
    series.x.push_back(width * static_cast<double>(series.x.size()));
    series.y.push_back(count.get<double>());
  }
  plot.series.push_back(std::move(series));
  return plot;
}

std::vector<Plot> tree_plots(const json& report) {
  const json &levels = report.at("levels"), &octree = report.at("octree_levels");
  Plot inaccuracy = titled("Inaccuracy by level", "level", kOverRadius, true);
  add_levels(inaccuracy, "mean", levels, "mean_inaccuracy_over_radius");
  add_levels(inaccuracy, "max", levels, "max_inaccuracy_over_radius");
  add_levels(inaccuracy, "octree's mean", octree, "mean_inaccuracy_over_radius", true);
  add_levels(inaccuracy, "octree's max", octree, "max_inaccuracy_over_radius", true);
  Plot outside = titled("Volume outside the solid", "level", "volumes of the solid", true);
  add_levels(outside, "", levels, "outside_volume_over_solid");
  std::vector<Plot> plots{inaccuracy, outside};
  for (std::size_t i = 1; i < levels.size(); ++i)
    plots.push_back(bars_of("Level " + std::to_string(i) + ": spheres by inaccuracy", kOverRadius, "spheres",
                            levels[i].at("histogram_up_to_max"), number_at(levels[i], "histogram_bin_over_radius")));
  return plots;
}

// Points of several systems or runs: what each has against its number of balls.
Plot against_balls(const std::string& title) {
  Plot plot = titled(title, "balls", "% of the diagonal", false);
  plot.log_x = plot.log_y_if_wide = true;
  return plot;
}

void add_point(Series& series, double balls, double value) {
  series.x.push_back(balls);
  series.y.push_back(value);
}

std::vector<Plot> axis_plots(const json& report) {
  std::vector<Plot> plots;
  if (const auto curve = report.find("error_curve"); curve != report.end()) {
    Plot plot = against_balls("Two-sided distance of surface and envelope");
    for (const auto& [name, key] : {std::pair{"maximum", "hausdorff_max"}, {"mean", "hausdorff_mean"}}) {
      Series series = line_named(name);
      for (const json& row : *curve) add_point(series, number_at(row, "vertices"), number_at(row, key));
      plot.series.push_back(std::move(series));
    }
    plots.push_back(std::move(plot));
  }
  if (const auto beside = report.find("beside"); beside != report.end() && report.contains("quality")) {
    Plot plot = against_balls("Largest two-sided distance of each axis");
    Series own = line_named("this axis");
    add_point(own, number_at(report.at("quality"), "balls"), number_at(report.at("quality"), "hausdorff_max"));
    plot.series.push_back(std::move(own));
    for (const json& other : *beside) {
      Series series = line_named(std::filesystem::path(other.value("axis", "")).filename().string());
      add_point(series, number_at(other.at("quality"), "balls"), number_at(other.at("quality"), "hausdorff_max"));
      plot.series.push_back(std::move(series));
    }
    plots.push_back(std::move(plot));
  }
  return plots;
}

// Series by system, each a line through its numbers of balls.
Plot by_system(const std::string& title, const std::vector<const json*>& rows, const char* measure) {
  Plot plot = against_balls(title);
  std::map<std::string, Series> lines;
  for (const json* row : rows) {
    const std::string system = row->at("system");
    Series& series = lines.try_emplace(system, line_named(system)).first->second;
    add_point(series, number_at(*row, "balls"), number_at(row->at("measures"), measure));
  }
  for (auto& [system, series] : lines) plot.series.push_back(std::move(series));
  return plot;
}

std::vector<Plot> leaderboard_plots(const json& report) {
  std::map<std::string, std::vector<const json*>> models;
  for (const json& row : report.at("rows"))
    if (row.at("comparable").get<bool>()) models[row.at("model").get<std::string>()].push_back(&row);
  std::vector<Plot> plots;
  for (const auto& [model, rows] : models)
    for (const auto& [measure, title] : {std::pair{"hausdorff_max", "largest"}, {"hausdorff_mean", "mean"}})
      plots.push_back(by_system(model + ": " + title + " distance", rows, measure));
  return plots;
}

std::vector<Plot> compared_axes_plots(const json& report) {
  std::vector<Plot> plots;
  for (const auto& [measure, title] : {std::pair{"hausdorff_max", "Largest"}, {"hausdorff_mean", "Mean"}}) {
    Plot plot = against_balls(std::string(title) + " distance at equal size");
    for (const json& axis : report.at("axes")) {
      Series& own = plot.series.emplace_back(line_named(axis.at("file").get<std::string>()));
      add_point(own, number_at(axis, "balls"), number_at(axis.at("quality"), measure));
    }
    Series& same = plot.series.emplace_back(line_named("orchard", true));
    for (const json& axis : report.at("own_axes"))
      add_point(same, number_at(axis, "balls"), number_at(axis.at("quality"), measure));
    plots.push_back(std::move(plot));
  }
  return plots;
}

std::vector<Plot> sphere_set_plots(const json& report) {
  const auto curve = report.find("error_curve");
  if (curve == report.end()) return {};
  std::vector<Plot> plots;
  const auto add = [&](const char* title, const char* unit,
                       std::initializer_list<std::pair<const char*, const char*>> lines) {
    Plot plot = titled(title, "spheres", unit, true);
    for (const auto& [name, key] : lines) {
      Series series = line_named(name);
      for (const json& row : *curve) add_point(series, number_at(row, "spheres"), number_at(row, key));
      plot.series.push_back(std::move(series));
    }
    plots.push_back(std::move(plot));
  };
  add("Distance against spheres", "% of the diagonal",
      {{"protrusion, max", "protrusion_max"},
       {"protrusion, mean", "protrusion_mean"},
       {"gap, max", "gap_max"},
       {"two-sided, mean", "two_sided_mean"}});
  add("Volume against spheres", "% of the solid's", {{"outside", "outside_volume"}, {"left out", "uncovered_volume"}});
  return plots;
}

std::vector<Plot> simulation_plots(const json& report) {
  std::vector<Plot> plots;
  if (report.at("maybe") != 0)
    plots.push_back(
        bars_of("Answers \"maybe\" by the level reached", "level", "answers", report.at("maybe_by_level"), 1));
  Plot times = titled("Time of a frame", "percentile", "microseconds", true);
  times.x_names = {"p50", "p99", "p99.9", "max"};
  for (const char* what : {"detection", "other"}) {
    Series series = line_named(what);
    for (std::size_t i = 0; i < times.x_names.size(); ++i)
      add_point(series, static_cast<double>(i),
                number_at(report.at("microseconds").at(what), times.x_names[i].c_str()));
    times.series.push_back(std::move(series));
  }
  plots.push_back(std::move(times));
  return plots;
}

std::vector<Plot> thickness_plots(const json& report) {
  const auto histogram = report.find("histogram");
  if (histogram == report.end()) return {};
  const std::string unit = report.at("unit").is_string() ? report.at("unit").get<std::string>() : "mesh units";
  return {bars_of("Area by thickness", "thickness, " + unit, "area", histogram->at("thickness_area"),
                  number_at(*histogram, "bin_width"))};
}

// A file's name without its ending, where that distinguishes the files.
std::string short_name(const json& file, const json& files) {
  const auto stem = [](const json& one) {
    return std::filesystem::path(one.at("file").get<std::string>()).stem().string();
  };
  const auto same = std::count_if(files.begin(), files.end(), [&](const json& one) { return stem(one) == stem(file); });
  return same > 1 ? file.at("file").get<std::string>() : stem(file);
}

std::vector<Plot> all_plots(const std::string& kind, const json& report) {
  if (kind == "build") return tree_plots(report);
  if (kind == "medial") return axis_plots(report);
  if (kind == "medial_sweep") return trade_off_plots(report);
  if (kind == "compare") return compare_plots(report);
  if (kind == "compare_axes") return compared_axes_plots(report);
  if (kind == "spheres") return sphere_set_plots(report);
  if (kind == "profile") return profile_plots(report);
  if (kind == "simulate") return simulation_plots(report);
  if (kind == "thickness") return thickness_plots(report);
  if (kind == "leaderboard") return leaderboard_plots(report);
  return {};
}

}  // namespace

std::vector<Plot> compare_plots(const json& report) {
  std::vector<Plot> plots;
  for (const auto& [key, title, unit] :
       {std::tuple{"mean_inaccuracy_over_radius", "Mean inaccuracy", "over the bounding radius"},
        {"max_inaccuracy_over_radius", "Largest inaccuracy", "over the bounding radius"},
        {"outside_volume_over_solid", "Volume outside", "over the solid's volume"}}) {
    Plot plot = titled(title, "level", unit, true);
    for (const json& file : report.at("files"))
      add_levels(plot, short_name(file, report.at("files")), file.at("levels"), key);
    plots.push_back(std::move(plot));
  }
  return plots;
}

std::vector<Plot> profile_plots(const json& report) {
  Plot decided = titled("Decided", "level", "% of those apart that the roots leave", false);
  decided.levels = {100};
  Plot bounds = titled("Bound of \"maybe\"", "separation bound / R", "poses", false);
  Plot trade = titled("Accuracy against time", "microseconds, median", "separation bound / R, median", true);
  Series share = line_named(""), curve = line_named("");
  for (const json& level : report.at("levels")) {
    const std::string name = level.at("level");
    add_point(share, static_cast<double>(decided.x_names.size()), 100 * number_at(level, "decided_of_left_by_roots"));
    decided.x_names.push_back(name);
    if (level.at("bound_over_radius").is_null() || name == "0" || name == "exact") continue;
    add_point(curve, number_at(level.at("microseconds"), "median"), number_at(level.at("bound_over_radius"), "median"));
    Series line = line_named("level " + name);
    const double width = number_at(level, "bound_histogram_bin");
    for (const json& count : level.at("bound_histogram"))
      add_point(line, (static_cast<double>(line.x.size()) + 0.5) * width, count);
    bounds.series.push_back(std::move(line));
  }
  decided.series = {share};
  trade.series = {curve};
  return {decided, bounds, trade};
}

bool shows_something(const Plot& plot) {
  std::vector<double> places;
  for (const Series& series : plot.series)
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      const bool drawn = std::isfinite(series.x[i]) && std::isfinite(series.y[i]) &&
                         !(plot.log_y && series.y[i] <= 0) && !(plot.log_x && series.x[i] <= 0);
      if (series.kind == Series::Kind::bars && drawn && series.y[i] != 0) return true;
      if (drawn) places.push_back(series.x[i]);
    }
  return !places.empty() && (plot.series.size() > 1 || *std::max_element(places.begin(), places.end()) >
                                                           *std::min_element(places.begin(), places.end()));
}

std::vector<Plot> report_plots(const std::string& kind, const json& report) {
  std::vector<Plot> plots = all_plots(kind, report);
  std::erase_if(plots, [](const Plot& plot) { return !shows_something(plot); });
  return plots;
}

}  // namespace orchard::apps
