#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

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
#include "report/report_page.h"
#include "report/report_plots.h"
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
  for (const std::filesystem::path& file : command.files) check_input(file);
  std::vector<std::filesystem::path> inputs = command.files;
  inputs.push_back(command.mesh);
  if (!command.plot.empty()) check_output(command.plot, inputs);
  std::vector<SphereLists> all;
  for (const std::filesystem::path& file : command.files) all.push_back(read_spheres(file));
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

std::string chart(const json& report, const std::string& title) {
  std::vector<plot::Plot> plots = compare_plots(report);
  for (plot::Plot& plot : plots) plot.title = title + ": " + plot.title;
  return plot::to_svg(plots, 3);
}

bool is_tree(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".orchard" || extension == ".sph" || extension == ".json";
}

// Whether the files are axes. Throws InputError for some of each, and for options that belong to the others.
bool are_axes(const CompareCommand& command) {
  const auto trees = std::count_if(command.files.begin(), command.files.end(), is_tree);
  if (trees == 0) return true;
  if (trees < std::ssize(command.files))
    throw InputError(
        "compare: some files are sphere-trees (.orchard, .sph, .json) and some are medial axes; compare them "
        "separately");
  for (const char* option : {"vertices", "csv", "quality-samples", "samples", "seed", "connect", "up"})
    if (std::find(command.given.begin(), command.given.end(), option) != command.given.end())
      throw InputError(fmt::format("--{} has no effect on sphere-trees; it is for medial axes", option));
  return false;
}

}  // namespace

void compare(const CompareCommand& command) {
  if (command.report && command.folder.empty())
    throw InputError("--report needs -o FOLDER, where the page is written to");
  if (are_axes(command)) {
    compare_axes(command);
    return;
  }
  const std::vector<SphereLists> lists = check_and_read(command);
  std::vector<std::filesystem::path> inputs = command.files;
  inputs.insert(inputs.begin(), command.mesh);
  const Destination destination{.folder = command.folder,
                                .report = named(command.mesh, "-compare.json"),
                                .provenance = provenance_of(command.output.run, inputs),
                                .force = command.output.force};
  if (!command.folder.empty()) check_outputs(destination, std::array{page_name(command.mesh, "compare")}, inputs);
  ProgressBar bar(!command.output.quiet && !command.output.json);
  const SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  bar.clear();
  if (!command.output.quiet && !command.output.json) print_solid(command.mesh, solid);
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, solid.surface.bounding_radius());
  const Surface& surface = solid.surface;
  const double radius = surface.bounding_radius();
  std::vector<Compared> all;
  for (std::size_t i = 0; i < lists.size(); ++i) all.push_back(measure_lists(surface, command.files[i], lists[i]));
  bar.clear();
  json report = compared_json(all, radius);
  add_solid_json(solid, report);
  report["provenance"] = to_json(destination.provenance);
  if (!command.plot.empty()) {
    const Writing writing;
    write_file(command.plot,
               stamped(chart(report, command.mesh.stem().string()), "plot.svg", line_of(destination.provenance)));
  }
  std::optional<Outputs> outputs;
  if (!command.folder.empty()) {
    outputs.emplace(destination);
    outputs->add_report(report, "this report as JSON");
    if (command.report) write_report_page(page_name(command.mesh, "compare"), {.report = report}, *outputs);
    outputs->commit();
  }
  if (command.output.json) {
    fmt::print("{}\n", report.dump(2));
  } else if (!command.output.quiet) {
    print_compared(all, surface.mesh().triangles.size(), radius);
    if (outputs) outputs->print();
    if (!command.plot.empty()) fmt::print("  {}  (the table as a plot)\n", command.plot.string());
  }
}

}  // namespace orchard::apps
