#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "output/outputs.h"

// The runs of a sweep, one after the other, each kept as soon as it is done.
namespace orchard::apps {

struct SweepRuns {
  std::vector<nlohmann::json> rows;  // of each run of the command: every measure by its name; null: not defined
  std::size_t taken_over = 0;        // of them, from an earlier sweep
};

// The file in the folder of a sweep that keeps its rows, and the folder beside it that has what --keep writes.
std::string sweep_rows_name(const MedialCommand& command);
std::string sweep_runs_folder(const MedialCommand& command);

// Builds and measures every run of the command. Rows that an earlier sweep left in the folder are taken over if the
// version of orchard, the bytes of the inputs and all options of the run are the same, and, with --keep, if the run's
// files are there. A sweep that is stopped loses no more than the run that it was at.
SweepRuns make_sweep_runs(const MedialCommand& command, const Destination& destination, ProgressBar& bar);

}  // namespace orchard::apps
