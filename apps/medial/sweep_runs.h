#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "output/outputs.h"

// Builds and measures the runs of a sweep, one after the other, and saves each as soon as it is done.
namespace orchard::apps {

// The results of a sweep.
struct SweepRuns {
  std::vector<nlohmann::json> rows;  // by run of the command: an object with all measures by name; null if undefined
  std::size_t taken_over = 0;        // the number of rows that are from an earlier sweep
};

// Return the names of the file in which a sweep saves its rows, and of the folder beside it for the files of --keep.
std::string sweep_rows_name(const MedialCommand& command);
std::string sweep_runs_folder(const MedialCommand& command);

// Builds and measures every run of the command. Rows that an earlier sweep left in the folder are taken over if the
// version of orchard, the bytes of the inputs and all options of the run are the same, and, with --keep, if the run's
// files are there. A sweep that is stopped loses only the run that was under way.
SweepRuns make_sweep_runs(const MedialCommand& command, const Destination& destination, ProgressBar& bar);

}  // namespace orchard::apps
