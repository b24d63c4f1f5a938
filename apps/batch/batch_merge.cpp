#include "batch/batch_merge.h"

#include <fmt/core.h>

#include "batch/merged_rows.h"
#include "batch/merged_tables.h"
#include "command_line/text.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "output/outputs.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr const char* kSummary = "batch-summary.json";

// The provenance of merged files: how the results were made, not how or where they were merged.
Provenance provenance_of(const json& description) {
  const std::string command_line = description.value("command_line", "");
  return {.run = {.typed = command_line,
                  .command_line = command_line,
                  .options = description.value("options", json::object()),
                  .seed = {}},
          .inputs = {}};
}

void print_merged(const json& summary, const MergedRows& rows, const Outputs& outputs) {
  const json& statuses = summary["statuses"];
  fmt::print("{} meshes of {} shard{}: {} solid, {} repaired, {} wrapped, {} failed\n", rows.lines.size(), rows.shards,
             rows.shards == 1 ? "" : "s", statuses["solid"].dump(), statuses["repaired"].dump(),
             statuses["wrapped"].dump(), statuses["failed"].dump());
  for (const auto& [why, count] : summary["failures"].items()) fmt::print("  failed: {:<10} {}\n", why, count.dump());
  for (const json& message : summary["messages"])
    fmt::print("  {:>6} x  {}\n", message["meshes"].dump(), message["message"].get<std::string>());
  if (summary["promises_not_kept"] != 0) fmt::print("  promise not kept:  {}\n", summary["promises_not_kept"].dump());
  if (const json& tightness = summary["tightness"]; !tightness.is_null())
    fmt::print("  tightness: median {:.4g}, 95 % below {:.4g}, at most {:.4g}\n", tightness["median"].get<double>(),
               tightness["percentile_95"].get<double>(), tightness["max"].get<double>());
  outputs.print();
}

}  // namespace

void merge_batches(const BatchCommand& command) {
  if (command.sources.size() < 2)
    throw InputError("batch merge: name the folders of the batch, such as \"orchard batch merge out -o out/table\"");
  if (command.folder.empty()) throw InputError("batch merge: --output is required: the folder for the table");
  if (!command.worker.empty())
    throw InputError("batch merge: leave out the command after --, because the results exist already");
  const MergedRows rows = read_merged_rows({command.sources.begin() + 1, command.sources.end()});
  const Destination destination{
      .folder = command.folder, .report = kSummary, .provenance = provenance_of(rows.description), .force = true};
  const std::vector<std::string> names{"batch.jsonl", "batch.csv", "batch-costs.csv", "batch.svg"};
  check_outputs(destination, names, {});
  Outputs outputs(destination);
  write_file(outputs.add("batch.jsonl", "a row a mesh"), joined(rows.lines, "\n") + "\n");
  write_file(outputs.add("batch.csv", "the same as a table"), rows_csv(rows));
  write_file(outputs.add("batch-costs.csv", "seconds and peak memory of each mesh"), costs_csv(rows));
  if (const std::vector<plot::Plot> plots = plots_of(rows); !plots.empty())
    write_file(outputs.add("batch.svg", "time against triangles, histogram of tightness"), plot::to_svg(plots, 2));
  json summary = summary_of(rows);
  outputs.add_report(summary, "how many were solid, repaired, wrapped, failed and why");
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", summary.dump(2));
  if (!command.output.json && !command.output.quiet) print_merged(summary, rows, outputs);
}

}  // namespace orchard::apps
