#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "batch/worker.h"

namespace orchard::apps {

// What came of one mesh.
//
// `row`, the same on every machine and in every sharding:
//   status     solid, repaired or wrapped: what the mesh was; failed: there is no result
//   why        of a failure: refused (bad input), crashed (a signal), timeout, memory, killed (SIGKILL from outside),
//   error
//              (a full disk and the like); else null
//   exit_code  of the command, or null
//   message    what it said on its error output, without the folders of this machine
//   repairs    the counts of what was repaired, by the names of the report, where they are not 0
//   notes      what was said of reading and repair
//   promise_kept   whether the result has what the command promises; null of a failure
//   figures    of the report, by name (result_figures.h)
// `cost`: seconds, peak_bytes, and the limits that held.
struct MeshResult {
  nlohmann::ordered_json row, cost;
  // Another run would give the same: it is kept. A worker that was killed from outside, or that failed through the
  // machine, is tried again by the next run.
  bool lasting = true;
};

// folder: which the worker wrote to.
MeshResult result_of(const WorkerEnd& end, const std::string& command, const std::filesystem::path& mesh,
                     const std::string& name, const std::filesystem::path& folder, const WorkerLimits& limits);

// Of a mesh that no worker was started for, such as a file larger than the memory that is allowed.
MeshResult refused_result(const std::string& message, const WorkerLimits& limits);

// Whether a failure through a limit is worth another try, the limits being larger now.
bool outgrown(const MeshResult& earlier, const WorkerLimits& limits);

}  // namespace orchard::apps
