#include "sweep_columns.h"

#include <fmt/format.h>

#include <cmath>

#include "orchard/spheretree/outside_volume.h"
#include "sphere_lists.h"

namespace orchard::apps {
namespace {

// What a run gave, by column.
struct Metric {
  const char* column;
  const char* title;
  double (*get)(const MedialBuild&, const MedialJudgement&);
};

double whole_seconds(const MedialBuild& build) {
  double sum = 0;
  for (const auto& [stage, time] : build.seconds) sum += time;
  return sum;
}

using B = MedialBuild;
using J = MedialJudgement;
constexpr Metric kMetrics[] = {
    {"points_added", "Points added by gap repair",
     [](const B& b, const J&) { return static_cast<double>(b.sampling.size()) - b.points; }},
    {"still_crossing", "Faces still crossing",
     [](const B& b, const J&) { return double{1} * b.gap_repair.faces_still_crossing; }},
    {"vertices", "Medial vertices", [](const B& b, const J&) { return double{1} * b.axis.size(); }},
    {"coverage_max", "Coverage error, max (% of the diagonal)",
     [](const B&, const J& j) { return 100 * j.quality.coverage.max; }},
    {"coverage_mean", "Coverage error, mean (% of the diagonal)",
     [](const B&, const J& j) { return 100 * j.quality.coverage.mean; }},
    {"protrusion_max", "Protrusion, max (% of the diagonal)",
     [](const B&, const J& j) { return 100 * j.quality.protrusion.max; }},
    {"protrusion_mean", "Protrusion, mean (% of the diagonal)",
     [](const B&, const J& j) { return 100 * j.quality.protrusion.mean; }},
    {"radius_error_max", "Radius error, max (% of the diagonal)",
     [](const B&, const J& j) { return 100 * j.quality.radius_error.max; }},
    {"radius_error_mean", "Radius error, mean (% of the diagonal)",
     [](const B&, const J& j) { return 100 * j.quality.radius_error.mean; }},
    {"centredness_max", "Centredness, max (of the radius)",
     [](const B&, const J& j) { return j.quality.centredness.max; }},
    {"centredness_mean", "Centredness, mean (of the radius)",
     [](const B&, const J& j) { return j.quality.centredness.mean; }},
    {"components", "Components", [](const B&, const J& j) { return double(j.quality.found.components); }},
    {"loops", "Loops", [](const B&, const J& j) { return double(j.quality.found.loops); }},
    {"cavities", "Cavities", [](const B&, const J& j) { return double(j.quality.found.cavities); }},
    {"euler_characteristic", "Euler characteristic",
     [](const B&, const J& j) { return double(j.quality.found.euler_characteristic()); }},
    {"topology_right", "Topology right (1) or wrong (0)",
     [](const B&, const J& j) { return j.quality.found == j.quality.wanted ? 1.0 : 0.0; }},
    {"outside_vertices", "Vertices outside (fraction)",
     [](const B&, const J& j) { return j.quality.outside_vertices; }},
    {"outside_edges", "Edge samples outside (fraction)", [](const B&, const J& j) { return j.quality.outside_edges; }},
    {"outside_triangles", "Face samples outside (fraction)",
     [](const B&, const J& j) { return j.quality.outside_triangles; }},
    {"stability_max", "Stability, max (times the noise)",
     [](const B&, const J& j) { return j.stability ? j.stability->hausdorff : std::nan(""); }},
    {"stability_99", "Stability, 99 % of vertices (times the noise)",
     [](const B&, const J& j) { return j.stability ? j.stability->percentile99 : std::nan(""); }},
    {"stability_mean", "Stability, mean (times the noise)",
     [](const B&, const J& j) { return j.stability ? j.stability->mean : std::nan(""); }},
    {"economy_spheres", "Economy (spheres for 1 %)",
     [](const B&, const J& j) { return double{1} * j.quality.economy.spheres; }},
    {"economy_uncovered", "Economy: surface not reached (fraction)",
     [](const B&, const J& j) { return j.quality.economy.uncovered; }},
    {"seconds", "Seconds to build", [](const B& b, const J&) { return whole_seconds(b); }},
};

}  // namespace

std::vector<Column> columns_of(const MedialCommand& command) {
  std::vector<Column> columns;
  for (const Metric& metric : kMetrics) columns.push_back({metric.column, metric.title});
  for (Index level = 1; command.tree && level <= command.tree->depth; ++level) {
    const auto add = [&](const char* name, const char* title) {
      columns.push_back({fmt::format("level_{}_{}", level, name), fmt::format("Level {}: {}", level, title)});
    };
    add("spheres", "spheres");
    add("mean", "inaccuracy, mean (of the bounding radius)");
    add("max", "inaccuracy, max (of the bounding radius)");
    add("outside", "volume outside (of the solid's)");
  }
  return columns;
}

std::vector<double> axis_numbers(const MedialBuild& build, const MedialJudgement& judgement) {
  std::vector<double> numbers;
  for (const Metric& metric : kMetrics) numbers.push_back(metric.get(build, judgement));
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
