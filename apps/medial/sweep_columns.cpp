#include "medial/sweep_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "orchard/spheretree/outside_volume.h"
#include "output/sphere_lists.h"

namespace orchard::apps {
namespace {

// What a build gave, by column, beside the measures of its axis.
struct BuildColumn {
  Column column;
  double (*get)(const MedialBuild&);
};

double sum_of(const StageTimes& times) {
  double sum = 0;
  for (const auto& [stage, time] : times) sum += time;
  return sum;
}

double whole_seconds(const MedialBuild& build) { return sum_of(build.seconds); }

const std::vector<BuildColumn>& build_columns() {
  static const std::vector<BuildColumn> columns{
      {{"points_added", "points added by gap repair", true},
       [](const MedialBuild& b) { return static_cast<double>(b.sampling.size()) - b.points; }},
      {{"still_crossing", "faces still crossing", true},
       [](const MedialBuild& b) { return double{1} * b.gap_repair.faces_still_crossing; }},
      {{"vertices", "medial vertices", true}, [](const MedialBuild& b) { return double{1} * b.axis.size(); }},
      {{"seconds", "seconds to build", true}, whole_seconds}};
  return columns;
}

// What is measured against another axis has no place in a sweep.
bool in_sweeps(const MedialMeasure& measure) { return !std::string_view(measure.name).starts_with("distance_"); }

}  // namespace

std::vector<Column> all_columns(const MedialCommand& command) {
  std::vector<Column> columns;
  for (const BuildColumn& own : build_columns()) columns.push_back(own.column);
  for (const MedialMeasure& measure : medial_measures()) {
    if (!in_sweeps(measure)) continue;
    const std::string unit = *measure.unit == '\0' ? "" : fmt::format(" ({})", measure.unit);
    columns.push_back({measure.name, measure.title + unit, measure.rates});
  }
  for (Index level = 1; command.tree && level <= command.tree->depth; ++level) {
    const auto add = [&](const char* name, const char* title) {
      columns.push_back({fmt::format("level_{}_{}", level, name), fmt::format("Level {}: {}", level, title), true});
    };
    add("spheres", "spheres");
    add("mean", "inaccuracy, mean (of the bounding radius)");
    add("max", "inaccuracy, max (of the bounding radius)");
    add("outside", "volume outside (of the solid's)");
  }
  return columns;
}

std::vector<Column> columns_of(const MedialCommand& command) {
  std::vector<Column> columns = all_columns(command);
  std::erase_if(columns, [&](const Column& column) {
    return std::any_of(command.swept.begin(), command.swept.end(),
                       [&](const SweptOption& option) { return option.name == column.name; });
  });
  return columns;
}

std::vector<double> axis_numbers(const MedialBuild& build, const MedialJudgement& judgement, const StageTimes& more) {
  std::vector<double> numbers;
  for (const BuildColumn& own : build_columns()) {
    numbers.push_back(own.get(build));
    if (own.column.name == "seconds") numbers.back() += sum_of(more);
  }
  for (const MedialMeasure& measure : medial_measures()) {
    if (in_sweeps(measure)) numbers.push_back(measure.get(judgement));
  }
  return numbers;
}

std::vector<double> tree_numbers(const SphereTreeBuild& built, const Surface& surface, Index depth) {
  std::vector<double> numbers;
  const auto figures = level_figures(built.tree, surface.bounding_radius());
  const SphereLists lists = levels_of(built.tree);
  for (std::size_t level = 1; level <= depth; ++level) {
    if (level >= figures.size()) {
      numbers.insert(numbers.end(), 4, std::nan(""));
      continue;
    }
    Level all = lists.levels[level];
    all.insert(all.end(), lists.carried[level].begin(), lists.carried[level].end());
    numbers.insert(numbers.end(),
                   {double{1} * figures[level].spheres, figures[level].mean_inaccuracy, figures[level].max_inaccuracy,
                    outside_volume(surface, all) / surface.report().volume});
  }
  return numbers;
}

}  // namespace orchard::apps
