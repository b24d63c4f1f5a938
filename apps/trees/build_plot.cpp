#include "trees/build_plot.h"

#include <algorithm>

#include "orchard/spheretree/outside_volume.h"
#include "output/sphere_lists.h"

namespace orchard::apps {
namespace {

constexpr std::size_t kInaccuracyBins = 20;
constexpr std::uint64_t kPlotRays = 2000;  // for the volume: a plot shows no more

plot::Plot by_level(const std::string& title, const std::string& what) {
  plot::Plot plot;
  plot.title = title;
  plot.y_label = what;
  plot.x_label = "level";
  plot.log_y = true;
  return plot;
}

template <class Value>
void add_line(plot::Plot& plot, const std::string& name, std::size_t levels, bool octree, const Value& value) {
  plot::Series& series = plot.series.emplace_back();
  series.dashed = octree;
  series.name = name;
  series.kind = plot::Series::Kind::line;
  for (std::size_t level = 0; level < levels; ++level) {
    if (level >= plot.x_names.size()) plot.x_names.push_back(std::to_string(level));
    series.x.push_back(static_cast<double>(level));
    series.y.push_back(value(level));
  }
}

plot::Plot inaccuracies(const SphereTreeBuild& result, double radius, const std::string& title) {
  plot::Plot plot = by_level(title + ": inaccuracy", "inaccuracy / R");
  const auto add = [&](const std::string& name, const SphereTree& tree, bool octree) {
    const auto figures = level_figures(tree, radius);
    add_line(plot, name + "mean", figures.size(), octree, [&](std::size_t i) { return figures[i].mean_inaccuracy; });
    add_line(plot, name + "max", figures.size(), octree, [&](std::size_t i) { return figures[i].max_inaccuracy; });
  };
  add("", result.tree, false);
  add("octree's ", result.octree, true);
  return plot;
}

plot::Plot outside_volumes(const SphereTreeBuild& result, const Surface& surface) {
  plot::Plot plot = by_level("volume outside", "volume outside / solid's");
  const auto add = [&](const std::string& name, const SphereTree& tree, bool octree) {
    const SphereLists lists = levels_of(tree);
    add_line(plot, name, lists.levels.size(), octree, [&](std::size_t i) {
      Level all = lists.levels[i];
      all.insert(all.end(), lists.carried[i].begin(), lists.carried[i].end());
      return outside_volume(surface, all, kPlotRays) / surface.report().volume;
    });
  };
  add("tree", result.tree, false);
  add("octree", result.octree, true);
  return plot;
}

plot::Plot inaccuracy_histogram(const SphereTree& tree, Index level, double radius) {
  std::vector<double> values;
  for (const SphereNode& node : tree.nodes)
    if (node.level == level) values.push_back(node.inaccuracy / radius);
  const double max = std::max(*std::max_element(values.begin(), values.end()), 1e-12);
  plot::Plot plot;
  plot.title = "level " + std::to_string(level) + ": " + std::to_string(values.size()) + " spheres";
  plot.x_label = "inaccuracy / R";
  plot.y_label = "spheres";
  plot::Series& series = plot.series.emplace_back();
  series.kind = plot::Series::Kind::bars;
  series.y.assign(kInaccuracyBins, 0);
  for (std::size_t bin = 0; bin < kInaccuracyBins; ++bin)
    series.x.push_back(max * static_cast<double>(bin) / static_cast<double>(kInaccuracyBins));
  for (const double value : values)
    ++series.y[std::min(kInaccuracyBins - 1,
                        static_cast<std::size_t>(value / max * static_cast<double>(kInaccuracyBins)))];
  return plot;
}

}  // namespace

std::vector<plot::Plot> build_plots(const SphereTreeBuild& result, const Surface& surface, const std::string& title) {
  std::vector<plot::Plot> plots{inaccuracies(result, surface.bounding_radius(), title)};
  if (surface.solid()) plots.push_back(outside_volumes(result, surface));
  for (Index level = 1; level <= result.tree.depth(); ++level)
    plots.push_back(inaccuracy_histogram(result.tree, level, surface.bounding_radius()));
  return plots;
}

}  // namespace orchard::apps
