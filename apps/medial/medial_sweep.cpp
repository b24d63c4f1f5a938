#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "command_line/list_option.h"
#include "medial/medial_run.h"
#include "medial/sweep_columns.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "output/outputs.h"
#include "svg_plot.h"

namespace orchard::apps {
namespace {

struct Dimension {
  const TuningFlag* flag = nullptr;
  std::vector<std::string> values;
};

Dimension parse(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw InputError("--sweep " + text + ": expected NAME=VALUE,VALUE,..");
  const std::string name = text.substr(0, equals);
  const auto& flags = tuning_flags();
  const auto flag = std::find_if(flags.begin(), flags.end(), [&](const TuningFlag& f) { return f.name == name; });
  if (flag == flags.end()) {
    std::string names;
    for (const TuningFlag& f : flags) names += (names.empty() ? "" : ", ") + f.name;
    throw InputError("--sweep: no flag is called " + name + "; there are " + names);
  }
  auto values = list_items(text.substr(equals + 1));
  if (!values) throw InputError(fmt::format("--sweep {}: {}", text, kEmptyItem));
  Dimension dimension{.flag = &*flag, .values = std::move(*values)};
  for (const std::string& value : dimension.values) {
    if (const std::string fault = flag->fault(value); !fault.empty())
      throw InputError(fmt::format("--sweep {}: {}", name, fault));
    if (std::count(dimension.values.begin(), dimension.values.end(), value) > 1)
      throw InputError(fmt::format("--sweep {}: {} is there twice", text, value));
  }
  return dimension;
}

struct Run {
  std::vector<std::size_t> choice;  // of each dimension's values
  std::vector<double> metrics;
};

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string to_csv(const std::vector<Dimension>& dimensions, const std::vector<Column>& columns,
                   const std::vector<Run>& runs) {
  std::string text;
  for (const Dimension& dimension : dimensions) text += dimension.flag->name + ',';
  for (const Column& column : columns) text += column.name + (&column == &columns.back() ? "\n" : ",");
  for (const Run& run : runs) {
    for (std::size_t d = 0; d < dimensions.size(); ++d) text += dimensions[d].values[run.choice[d]] + ',';
    for (std::size_t m = 0; m < run.metrics.size(); ++m) {
      text += csv_number(run.metrics[m]) + (m + 1 == run.metrics.size() ? "\n" : ",");
    }
  }
  return text;
}

nlohmann::json to_json(const std::vector<Dimension>& dimensions, const std::vector<Column>& columns,
                       const std::vector<Run>& runs) {
  nlohmann::json rows = nlohmann::json::array();
  for (const Run& run : runs) {
    nlohmann::json row;
    for (std::size_t d = 0; d < dimensions.size(); ++d)
      row[dimensions[d].flag->name] = dimensions[d].values[run.choice[d]];
    for (std::size_t m = 0; m < run.metrics.size(); ++m) {
      row[columns[m].name] = std::isfinite(run.metrics[m]) ? nlohmann::json(run.metrics[m]) : nlohmann::json();
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

// The first dimension runs along x; each combination of the others is a line.
plot::Plot plot_of(std::size_t metric, const Column& column, const std::string& model,
                   const std::vector<Dimension>& dimensions, const std::vector<Run>& runs) {
  const bool names = !dimensions[0].flag->choices.empty();
  std::map<std::string, std::vector<std::pair<double, double>>> lines;
  for (const Run& run : runs) {
    std::string name;
    for (std::size_t d = 1; d < dimensions.size(); ++d) {
      name += (d > 1 ? ", " : "") + dimensions[d].flag->name + ' ' + dimensions[d].values[run.choice[d]];
    }
    const double x = names ? static_cast<double>(run.choice[0]) : std::stod(dimensions[0].values[run.choice[0]]);
    lines[name].emplace_back(x, run.metrics[metric]);
  }
  plot::Plot result{.title = model + ": " + column.title,
                    .x_label = dimensions[0].flag->name,
                    .y_label = column.title,
                    .log_x = dimensions[0].flag->name == "samples" || dimensions[0].flag->name == "coalesce",
                    .log_y_if_wide = true,
                    .series = {},
                    .levels = {0},
                    .x_names = names ? dimensions[0].values : std::vector<std::string>{}};
  for (auto& [name, points] : lines) {
    std::sort(points.begin(), points.end());
    plot::Series& series = result.series.emplace_back();
    series.name = name;
    series.kind = plot::Series::Kind::line;
    for (const auto& [x, y] : points) {
      series.x.push_back(x);
      series.y.push_back(y);
    }
  }
  return result;
}

// Counts through all combinations, the last dimension fastest; false after the last one.
bool next(std::vector<std::size_t>& choice, const std::vector<Dimension>& dimensions) {
  for (std::size_t d = choice.size(); d-- > 0;) {
    if (++choice[d] < dimensions[d].values.size()) return true;
    choice[d] = 0;
  }
  return false;
}

std::vector<Dimension> dimensions_of(const MedialCommand& command) {
  std::vector<Dimension> dimensions;
  for (const std::string& text : command.sweep) dimensions.push_back(parse(text));
  return dimensions;
}

MedialTuning tuning_of(const MedialCommand& command, const std::vector<Dimension>& dimensions,
                       const std::vector<std::size_t>& choice) {
  MedialTuning tuning = command.tuning;
  for (std::size_t d = 0; d < dimensions.size(); ++d) dimensions[d].flag->set(tuning, dimensions[d].values[choice[d]]);
  return tuning;
}

// From the very axis: its diagram is taken over.
SphereTreeBuild tree_of(const TreeRequest& wanted, const Surface& surface, const MedialBuildOptions& medial,
                        MedialBuild build, const Progress& progress) {
  SphereTreeOptions options = tree_options(wanted, medial.sampling.seed);
  options.medial = medial;
  options.samples_by_need = false;
  MedialBuildInput input;
  input.diagram = {std::move(build.diagram), std::move(build.sampling)};
  return build_sphere_tree(surface, options, progress, std::move(input));
}

// The column of command.best. Throws InputError unless there is one in which less is better.
std::size_t best_column(const MedialCommand& command, const std::vector<Column>& columns) {
  std::string names;
  for (std::size_t m = 0; m < columns.size(); ++m) {
    if (!columns[m].rates) continue;
    if (columns[m].name == command.best) return m;
    names += (names.empty() ? "" : ", ") + columns[m].name;
  }
  throw InputError(
      fmt::format("--sort-by: {} is no measure that is better or worse; there are {}", command.best, names));
}

std::size_t column_of(const std::vector<Column>& columns, const char* name) {
  return static_cast<std::size_t>(
      std::find_if(columns.begin(), columns.end(), [&](const Column& column) { return column.name == name; }) -
      columns.begin());
}

// Right topologies before wrong ones, then by the measure, what has none last; equals in the order of the sweep.
std::vector<Run> best_first(std::vector<Run> runs, std::size_t best, std::size_t topology) {
  std::stable_sort(runs.begin(), runs.end(), [&](const Run& a, const Run& b) {
    if (a.metrics[topology] != b.metrics[topology]) return a.metrics[topology] > b.metrics[topology];
    const double x = a.metrics[best], y = b.metrics[best];
    return std::isnan(y) ? !std::isnan(x) : x < y;
  });
  return runs;
}

// Some columns for the eye, that of the order first; the file has all of them.
void print_rows(const std::vector<Dimension>& dimensions, const std::vector<Column>& columns, std::size_t best,
                const std::vector<Run>& runs) {
  std::vector<std::size_t> shown{best};
  for (const char* name : {"hausdorff_max", "hausdorff_mean", "coverage_max", "protrusion_max", "radius_error_max",
                           "topology_right", "border_length", "small_pieces", "balls", "stability_99", "seconds"}) {
    if (const std::size_t m = column_of(columns, name); m != best) shown.push_back(m);
  }
  fmt::print("best first, by {}; right topologies before wrong ones\n", columns[best].name);
  const auto width = [](const std::string& title) { return std::max<std::size_t>(title.size(), 9); };
  for (const Dimension& dimension : dimensions)
    fmt::print("{:>{}}  ", dimension.flag->name, width(dimension.flag->name));
  for (const std::size_t m : shown) fmt::print("{:>{}}  ", columns[m].name, width(columns[m].name));
  fmt::print("\n");
  for (const Run& run : runs) {
    for (std::size_t d = 0; d < dimensions.size(); ++d)
      fmt::print("{:>{}}  ", dimensions[d].values[run.choice[d]], width(dimensions[d].flag->name));
    for (const std::size_t m : shown) {
      const double value = run.metrics[m];
      fmt::print("{:>{}}  ", std::isfinite(value) ? fmt::format("{:.5g}", value) : "-", width(columns[m].name));
    }
    fmt::print("\n");
  }
}

std::string csv_name(const MedialCommand& command) { return named(command.mesh, "-sweep.csv"); }

std::string plot_name(const MedialCommand& command, const Column& column) {
  return named(command.mesh, fmt::format("-sweep-{}.svg", column.name));
}

}  // namespace

std::vector<std::string> swept_flags(const MedialCommand& command) {
  std::vector<std::string> names;
  for (const Dimension& dimension : dimensions_of(command)) names.push_back(dimension.flag->name);
  return names;
}

std::vector<MedialTuning> tunings_of(const MedialCommand& command) {
  const std::vector<Dimension> dimensions = dimensions_of(command);
  std::vector<MedialTuning> tunings;
  std::vector<std::size_t> choice(dimensions.size(), 0);
  do {
    tunings.push_back(tuning_of(command, dimensions, choice));
  } while (next(choice, dimensions));
  return tunings;
}

void check_sweep(const MedialCommand& command) {
  for (const MedialTuning& tuning : tunings_of(command)) build_options(tuning);
  best_column(command, columns_of(command));
}

std::vector<std::string> sweep_names(const MedialCommand& command) {
  std::vector<std::string> names{csv_name(command)};
  for (const Column& column : columns_of(command)) names.push_back(plot_name(command, column));
  return names;
}

void sweep_medial(const MedialCommand& command, const Destination& destination, const Surface& surface,
                  const Progress& progress) {
  const std::vector<Dimension> dimensions = dimensions_of(command);
  std::vector<Run> runs;
  std::vector<std::size_t> choice(dimensions.size(), 0);
  do {
    const MedialBuildOptions options = build_options(tuning_of(command, dimensions, choice));
    MedialBuild build = build_medial_axis(surface, options, progress);
    const MedialJudgement judgement = judge(command, surface, build, medial_mesh(build.axis), options, progress);
    Run& run = runs.emplace_back();
    run.choice = choice;
    run.metrics = axis_numbers(build, judgement);
    if (command.tree) {
      const SphereTreeBuild tree = tree_of(*command.tree, surface, options, std::move(build), progress);
      const std::vector<double> numbers = tree_numbers(tree, surface, command.tree->depth);
      run.metrics.insert(run.metrics.end(), numbers.begin(), numbers.end());
    }
  } while (next(choice, dimensions));

  const std::vector<Column> columns = columns_of(command);
  const std::string csv = to_csv(dimensions, columns, runs);
  Outputs outputs(destination);
  write_file(outputs.add(csv_name(command)), csv);
  const std::string model = command.mesh.stem().string();
  for (std::size_t m = 0; m < columns.size(); ++m)
    write_file(outputs.add(plot_name(command, columns[m])),
               plot::to_svg({plot_of(m, columns[m], model, dimensions, runs)}));
  const std::size_t best = best_column(command, columns);
  runs = best_first(std::move(runs), best, column_of(columns, "topology_right"));
  nlohmann::json report{{"best_by", columns[best].name}, {"runs", to_json(dimensions, columns, runs)}};
  outputs.add_report(report);
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (command.output.quiet || command.output.json) return;
  print_rows(dimensions, columns, best, runs);
  fmt::print("  {}  ({} runs with all measures, and a plot for each beside it)\n",
             outputs.place_of(csv_name(command)).string(), runs.size());
  outputs.print();
}

}  // namespace orchard::apps
