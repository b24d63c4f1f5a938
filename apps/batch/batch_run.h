#pragma once
#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "batch/batch_folder.h"
#include "batch/batch_progress.h"
#include "batch/ordered_rows.h"
#include "batch/worker.h"

namespace orchard::apps {

// The results of one run.
struct BatchCounts {
  std::map<std::string, std::size_t> statuses;  // solid, repaired, wrapped, failed
  std::map<std::string, std::size_t> reasons;   // of failures
  std::size_t known_before = 0;                 // the number of meshes with stored results
  std::size_t broken_promises = 0;
  std::vector<std::string> not_lasting;  // names of meshes that should be tried again by another run
};

struct BatchRunOptions {
  std::size_t jobs = 1;
  WorkerLimits limits;
  // For tests: meshes by name whose worker is `orchard misbehave KIND` in place of the command.
  std::map<std::string, std::string> faults;
};

// Runs the meshes of one shard, each in a worker and `jobs` at a time, and writes their rows in order.
class BatchRun {
 public:
  BatchRun(const Manifest& manifest, const std::vector<std::size_t>& positions, const WorkerCommand& command,
           const BatchFolder& folder, const BatchRunOptions& options, BatchProgress& progress);

  // Returns when all are done. Throws Cancelled after a signal, and Error if it cannot write. The workers are then
  // killed, and finished results stay.
  BatchCounts run();

 private:
  struct Job {
    std::string key;
    const BatchMesh* mesh;
    std::filesystem::path folder;
    std::unique_ptr<Worker> worker;
  };

  void start_next();
  void start(const std::string& key, const BatchMesh& mesh);
  void look_at_workers();
  void finish(const std::string& key, const MeshResult& result, bool known_before);

  const Manifest& manifest_;
  const std::vector<std::size_t>& positions_;
  const WorkerCommand& command_;
  const BatchFolder& folder_;
  const BatchRunOptions& options_;
  BatchProgress& progress_;
  OrderedRows rows_, costs_;
  std::size_t next_ = 0;
  std::vector<Job> jobs_;
  // For each key that is being processed, the places of its rows.
  std::map<std::string, std::vector<std::size_t>> waiting_;
  BatchCounts counts_;
};

}  // namespace orchard::apps
