#include <fmt/core.h>

#include <algorithm>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "leaderboard/leaderboard_entries.h"
#include "leaderboard/leaderboard_pages.h"
#include "leaderboard/leaderboard_rows.h"
#include "leaderboard/leaderboard_states.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "output/outputs.h"
#include "report/report_page.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReport = "leaderboard.json";
constexpr const char* kPage = "leaderboard-report.html";

std::vector<std::string> models_of(const LeaderboardFolder& found) {
  std::vector<std::string> models;
  for (const LeaderboardEntry& entry : found.entries) {
    if (models.empty() || models.back() != entry.model) models.push_back(entry.model);
  }
  return models;
}

std::string plot_name(const std::string& model) { return model + "-leaderboard.svg"; }
std::string state_name(const std::string& model) { return model + "-worst.pvsm"; }

void print_rows(const std::vector<LeaderboardRow>& rows) {
  fmt::print("{:<20} {:>6} {:<18} {:>6} {:>9} {:>9}  {}\n", "mesh", "N", "system", "balls", "max %", "mean %",
             "topology");
  for (const LeaderboardRow& row : rows) {
    if (!row.refused.empty()) {
      fmt::print("{:<20} {:>6} {:<18} not measured: {}\n", row.model, row.asked, row.system, row.refused);
      continue;
    }
    fmt::print("{:<20} {:>6} {:<18} {:>6} {:>9.4f} {:>9.4f}  {}{}\n", row.model, row.asked, row.system, row.balls,
               row.value("hausdorff_max"), row.value("hausdorff_mean"), row.topology_right() ? "right" : "WRONG",
               row.comparable() ? "" : ", balls alone");
  }
  const LeaderboardScore all = score(rows);
  fmt::print("{} pairs: orchard is lower in the maximum in {}, in the mean in {}, topology right in {}\n", all.pairs,
             all.lower_max, all.lower_mean, all.right);
}

}  // namespace

void leaderboard(const LeaderboardCommand& command) {
  const LeaderboardFolder found = find_entries(command.input);
  if (found.entries.empty())
    throw InputError(
        command.input.string() +
        ": no axis was found; they are files MODEL-SYSTEM-N.ma (or .obj, .ply, ..) beside the meshes or in "
        "a folder named results");
  const std::vector<std::string> models = models_of(found);
  std::vector<fs::path> inputs;
  for (const LeaderboardEntry& entry : found.entries) {
    if (inputs.empty() || std::find(inputs.begin(), inputs.end(), entry.mesh) == inputs.end())
      inputs.push_back(entry.mesh);
    inputs.push_back(entry.file);
  }
  Destination destination{.folder = command.folder,
                          .report = kReport,
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  std::vector<std::string> names{"leaderboard.md", "leaderboard.csv", kPage};
  for (const std::string& model : models) {
    names.push_back(plot_name(model));
    names.push_back(state_name(model));
  }
  check_outputs(destination, names, inputs);
  const bool talk = !command.output.quiet && !command.output.json;
  ProgressBar bar(talk);
  const LeaderboardOptions options{
      .quality_samples = command.quality_samples,
      .vertices = command.vertices,
      .builders = command.builders.empty() ? std::vector<std::string>{"refined", "raw"} : command.builders,
      .connect = command.connect,
      .samples = command.samples,
      .seed = command.seed};
  const std::vector<LeaderboardRow> rows = measure_entries(found, options, command.folder, bar.callback());
  bar.clear();
  Outputs outputs(destination);
  std::vector<std::pair<std::string, std::string>> plots;
  for (const std::string& model : models) {
    plots.emplace_back(model, plot_name(model));
    write_file(outputs.add(plot_name(model)), to_svg(rows, model));
  }
  write_file(outputs.add("leaderboard.md", "the table, with what is not comparable"),
             to_markdown(rows, found.skipped, plots));
  write_file(outputs.add("leaderboard.csv", "every measure of every axis"), to_csv(rows));
  for (const std::string& model : models) {
    const std::string name = state_name(model);
    if (write_worst_state(outputs.staged(name), rows, model, command.folder))
      outputs.add(name, "opens its worst places in ParaView");
  }
  nlohmann::json report = to_json(rows, found.skipped);
  outputs.add_report(report, "the same as JSON");
  if (command.report) write_report_page(kPage, {.report = report}, outputs);
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (!talk) return;
  print_rows(rows);
  for (const std::string& words : found.skipped) fmt::print("no entry: {}\n", words);
  outputs.print();
}

}  // namespace orchard::apps
