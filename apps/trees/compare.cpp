#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "input/load_solid.h"
#include "input/reading_report.h"
#include "orchard/covering/coverage.h"
#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/outside_volume.h"
#include "output/outputs.h"
#include "output/sphere_lists.h"
#include "output/stamp.h"
#include "svg_plot.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

struct LevelRow {
  Index spheres = 0, carried = 0;
  double mean = 0, max = 0;       // inaccuracy, in mesh units
  double outside = 0;             // volume over the solid's
  Index triangles_uncovered = 0;  // by the path rule if the file has a tree, else by the level's union
};

struct Compared {
  std::string name;
  std::vector<LevelRow> levels;
  bool tree = false;
};

// The balls that a level's cover is judged by: whole paths, or each ball by itself.
std::vector<PathBall> balls_of_level(const SphereLists& lists, std::size_t level) {
  std::vector<PathBall> balls;
  if (lists.tree) {
    for (const SphereNode& node : lists.tree->nodes)
      if (node.level <= level)
        balls.push_back({node.sphere.center, node.sphere.radius, node.parent,
                         node.child_count == 0 || node.level == static_cast<Index>(level)});
    return balls;
  }
  for (const Level* list : {&lists.levels[level], &lists.carried[level]})
    for (const Sphere& s : *list) balls.push_back({s.center, s.radius, kNone, true});
  return balls;
}

LevelRow measure_level(const Surface& surface, double volume, const SphereLists& lists, std::size_t level) {
  LevelRow row;
  const Level& own = lists.levels[level];
  row.spheres = static_cast<Index>(own.size());
  row.carried = static_cast<Index>(lists.carried[level].size());
  std::vector<double> values(own.size());
  tbb::parallel_for(std::size_t{0}, own.size(), [&](std::size_t i) {
    values[i] = inaccuracy(surface, own[i], {tolerance::kInaccuracy, 0}).upper;
  });
  for (const double value : values) {
    row.mean += value / static_cast<double>(values.size());
    row.max = std::max(row.max, value);
  }
  Level all = own;
  all.insert(all.end(), lists.carried[level].begin(), lists.carried[level].end());
  row.outside = outside_volume(surface, all) / volume;
  row.triangles_uncovered =
      static_cast<Index>(surface_coverage(surface, balls_of_level(lists, level)).uncovered.size());
  return row;
}

Compared measure_lists(const Surface& surface, const std::filesystem::path& file, const SphereLists& lists) {
  Compared compared{file.filename().string(), {}, lists.tree.has_value()};
  for (std::size_t level = 0; level < lists.levels.size(); ++level)
    compared.levels.push_back(measure_level(surface, surface.report().volume, lists, level));
  return compared;
}

// What can be refused before anything is measured.
std::vector<SphereLists> check_and_read(const CompareCommand& command) {
  check_input(command.mesh);
  for (const std::filesystem::path& file : command.trees) check_input(file);
  std::vector<std::filesystem::path> inputs = command.trees;
  inputs.push_back(command.mesh);
  if (!command.plot.empty()) check_output(command.plot, inputs);
  std::vector<SphereLists> all;
  for (const std::filesystem::path& file : command.trees) all.push_back(read_spheres(file));
  return all;
}

json compared_json(const std::vector<Compared>& all, double radius) {
  json files = json::array();
  for (const Compared& compared : all) {
    json levels = json::array();
    for (const LevelRow& row : compared.levels)
      levels.push_back({{"spheres", row.spheres},
                        {"leaves_carried", row.carried},
                        {"mean_inaccuracy", row.mean},
                        {"max_inaccuracy", row.max},
                        {"mean_inaccuracy_over_radius", row.mean / radius},
                        {"max_inaccuracy_over_radius", row.max / radius},
                        {"outside_volume_over_solid", row.outside},
                        {"triangles_not_proven_covered", row.triangles_uncovered}});
    files.push_back({{"file", compared.name}, {"tree", compared.tree}, {"levels", levels}});
  }
  return {{"bounding_radius", radius}, {"files", files}};
}

void print_compared(const std::vector<Compared>& all, std::size_t triangles, double radius) {
  fmt::print("inaccuracy over the bounding radius, outside volume over the solid's; triangles without a path\n");
  fmt::print("level  spheres      mean       max   outside  uncovered  file\n");
  std::size_t levels = 0;
  for (const Compared& compared : all) levels = std::max(levels, compared.levels.size());
  for (std::size_t level = 0; level < levels; ++level)
    for (const Compared& compared : all) {
      if (level >= compared.levels.size()) continue;
      const LevelRow& row = compared.levels[level];
      fmt::print("{:5} {:8} {:9.5f} {:9.5f} {:9.4f} {:8.1f} %  {}{}\n", level, row.spheres, row.mean / radius,
                 row.max / radius, row.outside,
                 100.0 * static_cast<double>(row.triangles_uncovered) / static_cast<double>(triangles), compared.name,
                 compared.tree ? "" : " (levels only)");
    }
}

// Without the ending, where that tells the files apart all the same.
std::string short_name(const Compared& compared, const std::vector<Compared>& all) {
  const auto stem = [](const Compared& one) { return std::filesystem::path(one.name).stem().string(); };
  const auto same =
      std::count_if(all.begin(), all.end(), [&](const Compared& other) { return stem(other) == stem(compared); });
  return same > 1 ? compared.name : stem(compared);
}

std::string chart(const std::vector<Compared>& all, const std::string& title, double radius) {
  std::vector<plot::Plot> plots;
  const auto add = [&](const std::string& figure, const std::string& over, const auto& value) {
    plot::Plot& plot = plots.emplace_back();
    plot.title = title + ": " + figure;
    plot.x_label = "level";
    plot.y_label = over;
    plot.log_y = true;
    for (const Compared& compared : all) {
      plot::Series& series = plot.series.emplace_back();
      series.name = short_name(compared, all);
      series.kind = plot::Series::Kind::line;
      for (std::size_t level = 0; level < compared.levels.size(); ++level) {
        if (level >= plot.x_names.size()) plot.x_names.push_back(std::to_string(level));
        series.x.push_back(static_cast<double>(level));
        series.y.push_back(value(compared.levels[level]));
      }
    }
  };
  const std::string over_radius = "over the bounding radius";
  add("mean inaccuracy", over_radius, [&](const LevelRow& row) { return row.mean / radius; });
  add("maximum inaccuracy", over_radius, [&](const LevelRow& row) { return row.max / radius; });
  add("volume outside", "over the solid's volume", [](const LevelRow& row) { return row.outside; });
  return plot::to_svg(plots, 3);
}

}  // namespace

void compare(const CompareCommand& command) {
  const std::vector<SphereLists> lists = check_and_read(command);
  std::vector<std::filesystem::path> inputs = command.trees;
  inputs.insert(inputs.begin(), command.mesh);
  const Provenance provenance = provenance_of(command.output.run, inputs);
  ProgressBar bar(!command.output.quiet && !command.output.json);
  const SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  bar.clear();
  if (!command.output.quiet && !command.output.json) print_solid(command.mesh, solid);
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, solid.surface.bounding_radius());
  const Surface& surface = solid.surface;
  const double radius = surface.bounding_radius();
  std::vector<Compared> all;
  for (std::size_t i = 0; i < lists.size(); ++i) all.push_back(measure_lists(surface, command.trees[i], lists[i]));
  bar.clear();
  if (!command.plot.empty()) {
    const Writing writing;
    write_file(command.plot,
               stamped(chart(all, command.mesh.stem().string(), radius), "plot.svg", line_of(provenance)));
  }
  if (command.output.json) {
    json report = compared_json(all, radius);
    add_solid_json(solid, report);
    report["provenance"] = to_json(provenance);
    fmt::print("{}\n", report.dump(2));
  } else if (!command.output.quiet) {
    print_compared(all, surface.mesh().triangles.size(), radius);
    if (!command.plot.empty()) fmt::print("  {}  (the table as a plot)\n", command.plot.string());
  }
}

}  // namespace orchard::apps
