#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "medial/medial_run.h"
#include "medial/medial_simplify.h"
#include "medial/sweep_columns.h"
#include "medial/sweep_runs.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "output/outputs.h"
#include "report/report_page.h"
#include "report/report_plots.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

// The measures of a run, by name, and what was swept.
struct SweptRun {
  std::vector<std::string> choice;
  json measures;

  json measure(const std::string& name) const { return measures.value(name, json()); }
  double value(const std::string& name) const {
    const json found = measure(name);
    return found.is_number() ? found.get<double>() : std::nan("");
  }
};

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

// Whether a measure tells the runs apart.
bool differs(const std::string& name, const std::vector<SweptRun>& runs) {
  return runs.size() < 2 || std::any_of(runs.begin(), runs.end(), [&](const SweptRun& run) {
           return run.measure(name) != runs.front().measure(name);
         });
}

std::string sweep_csv(const MedialCommand& command, const std::vector<Column>& columns,
                      const std::vector<SweptRun>& runs) {
  std::string text;
  const auto cell = [&](const std::string& value) {
    text += (text.empty() || text.ends_with('\n') ? "" : ",") + value;
  };
  for (const SweptOption& option : command.swept) cell(option.name);
  for (const Column& column : columns) cell(column.name);
  text += '\n';
  for (const SweptRun& run : runs) {
    for (const std::string& value : run.choice) cell(value);
    for (const Column& column : columns) text += "," + csv_number(run.value(column.name));
    text += '\n';
  }
  return text;
}

json sweep_json(const MedialCommand& command, const std::vector<Column>& columns, const std::vector<SweptRun>& runs) {
  json rows = json::array();
  for (const SweptRun& run : runs) {
    json row;
    for (const Column& column : columns) row[column.name] = run.measure(column.name);
    for (std::size_t d = 0; d < command.swept.size(); ++d) row[command.swept[d].name] = run.choice[d];
    rows.push_back(std::move(row));
  }
  return rows;
}

// The column of command.best. Throws InputError unless there is one in which less is better.
const Column& best_column(const MedialCommand& command, const std::vector<Column>& columns) {
  std::string names;
  for (const Column& column : columns) {
    if (!column.rates) continue;
    if (column.name == command.best) return column;
    names += (names.empty() ? "" : ", ") + column.name;
  }
  throw InputError(
      fmt::format("--sort-by: {} is no measure that is better or worse; there are {}", command.best, names));
}

// Right topologies before wrong ones, then by the measure, what has none last; equals in the order of the sweep.
std::vector<SweptRun> best_first(std::vector<SweptRun> runs, const std::string& best) {
  std::stable_sort(runs.begin(), runs.end(), [&](const SweptRun& a, const SweptRun& b) {
    const double right = a.value("topology_right"), other = b.value("topology_right");
    if (right != other) return right > other;
    const double x = a.value(best), y = b.value(best);
    return std::isnan(y) ? !std::isnan(x) : x < y;
  });
  return runs;
}

std::string printed(double value) { return std::isfinite(value) ? fmt::format("{:.5g}", value) : "-"; }

// Some columns for the eye, that of the order first; the file has all that differ, the report all.
void print_rows(const MedialCommand& command, const std::string& best, const std::vector<SweptRun>& runs) {
  std::vector<std::string> shown{best};
  std::string same;
  for (const char* name : {"hausdorff_max", "hausdorff_mean", "coverage_max", "protrusion_max", "radius_error_max",
                           "topology_right", "border_length", "small_pieces", "balls", "stability_99", "seconds"}) {
    if (name == best) continue;
    if (differs(name, runs)) {
      shown.emplace_back(name);
    } else {
      same += fmt::format("{}{} {}", same.empty() ? "" : ", ", name, printed(runs.front().value(name)));
    }
  }
  fmt::print("best first, by {}; right topologies before wrong ones\n", best);
  if (!same.empty()) fmt::print("the same in all runs: {}\n", same);
  const auto width = [](const std::string& title) { return std::max<std::size_t>(title.size(), 9); };
  for (const SweptOption& option : command.swept) fmt::print("{:>{}}  ", option.name, width(option.name));
  for (const std::string& name : shown) fmt::print("{:>{}}  ", name, width(name));
  fmt::print("\n");
  for (const SweptRun& run : runs) {
    for (std::size_t d = 0; d < command.swept.size(); ++d)
      fmt::print("{:>{}}  ", run.choice[d], width(command.swept[d].name));
    for (const std::string& name : shown) fmt::print("{:>{}}  ", printed(run.value(name)), width(name));
    fmt::print("\n");
  }
}

std::string csv_name(const MedialCommand& command) { return named(command.mesh, "-sweep.csv"); }
std::string plot_name(const MedialCommand& command) { return named(command.mesh, "-sweep.svg"); }

}  // namespace

std::vector<std::string> swept_flags(const MedialCommand& command) {
  std::vector<std::string> names;
  for (const SweptOption& option : command.swept) names.push_back(option.name);
  return names;
}

std::vector<MedialTuning> tunings_of(const MedialCommand& command) {
  std::vector<MedialTuning> tunings;
  for (const MedialCommand& run : command.runs) tunings.push_back(run.tuning);
  if (tunings.empty()) tunings.push_back(command.tuning);
  return tunings;
}

void check_sweep(const MedialCommand& command) {
  for (const MedialTuning& tuning : tunings_of(command)) build_options(tuning);
  best_column(command, columns_of(command));
  if (command.sweep.empty()) return;
  for (const MedialCommand& run : command.runs) check_simplification(run);
}

std::vector<std::string> sweep_names(const MedialCommand& command) {
  return {csv_name(command), plot_name(command), sweep_rows_name(command), page_name(command.mesh, "medial-sweep")};
}

void sweep_medial(const MedialCommand& command, const Destination& destination, ProgressBar& bar) {
  SweepRuns made = make_sweep_runs(command, destination, bar);
  bar.clear();
  std::vector<SweptRun> runs;
  for (std::size_t i = 0; i < made.rows.size(); ++i) runs.push_back({command.runs[i].choice, std::move(made.rows[i])});
  const std::vector<Column> columns = columns_of(command);
  std::vector<Column> differing = columns;
  std::erase_if(differing, [&](const Column& column) { return !differs(column.name, runs); });
  const std::string best = best_column(command, columns).name;
  const std::vector<SweptRun> sorted = best_first(runs, best);
  json report{{"best_by", best},
              {"swept", swept_flags(command)},
              {"runs_taken_over", made.taken_over},
              {"runs", sweep_json(command, columns, sorted)}};
  Outputs outputs(destination);
  write_file(outputs.add(csv_name(command), "all measures that differ, a row for each run"),
             sweep_csv(command, differing, runs));
  const std::vector<plot::Plot> plots = report_plots("medial_sweep", report);
  if (!plots.empty())
    write_file(outputs.add(plot_name(command), "distances against balls, borders and seconds"),
               plot::to_svg(plots, std::min(3, static_cast<int>(plots.size()))));
  outputs.add_report(report, "this report as JSON");
  if (command.report) write_report_page(page_name(command.mesh, "medial-sweep"), {.report = report}, outputs);
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (command.output.quiet || command.output.json) return;
  print_rows(command, best, sorted);
  if (made.taken_over > 0)
    fmt::print("{} of {} runs were there already, in {}\n", made.taken_over, runs.size(),
               outputs.place_of(sweep_rows_name(command)).string());
  outputs.print();
  if (command.keep) fmt::print("  {}  (the axis of each run)\n", outputs.place_of(sweep_runs_folder(command)).string());
}

}  // namespace orchard::apps
