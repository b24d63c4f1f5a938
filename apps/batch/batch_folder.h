#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "batch/manifest.h"
#include "batch/result_row.h"
#include "batch/worker_command.h"

// The folder of a batch:
//   batch.json                 what its results are made with
//   results/ab/ab12../         everything of one mesh: its files, row.json, cost.json, log.txt
//   shards/1-of-4.jsonl        the rows of a shard that has run to its end, in the manifest's order
//   shards/1-of-4.costs.jsonl  their seconds and memory
//   shards/1-of-4.json         which manifest they are of
//   shards/1-of-4.lock         held while the shard runs
//   .work/1-of-4/              what is being made
// The folder of a mesh is named for what decides it: the bytes and the name of the file, the options and the version.
// It appears by one renaming, so that it is whole or not there, whatever ends the program.
namespace orchard::apps {

inline constexpr const char* kBatchFile = "batch.json";

// The name of a mesh's results: 64 hexadecimal digits. Throws InputError if the file cannot be read. Cost: reads it
// once.
std::string result_key(const std::filesystem::path& mesh, const WorkerCommand& worker);

// Returns the contents of batch.json.
nlohmann::json batch_description(const WorkerCommand& worker);

class BatchFolder {
 public:
  // Makes the folders that are missing, waits until another process with the same shard has ended, and removes
  // unfinished files of an earlier run. Throws InputError if the folder has results of other options or of another
  // version, or if the shard was begun before and `resume` is not set; Cancelled after a signal; Error if it cannot
  // write.
  BatchFolder(std::filesystem::path folder, const Shard& shard, const WorkerCommand& worker, bool resume);
  ~BatchFolder();
  BatchFolder(const BatchFolder&) = delete;
  BatchFolder& operator=(const BatchFolder&) = delete;

  // Returns the stored result of a mesh; nullopt if there is none.
  std::optional<MeshResult> find(const std::string& key) const;

  // Returns an empty folder for a worker to write to.
  std::filesystem::path begin(const std::string& key) const;
  // Moves that folder to the results of the mesh, unless another shard was faster; or removes it if the result is not
  // lasting. `log` is the output of the worker.
  void finish(const std::string& key, const MeshResult& result, const std::string& log) const;

  // The files in `.work`, which publish() moves to their places.
  std::filesystem::path rows_in_work() const { return work_ / "rows.jsonl"; }
  std::filesystem::path costs_in_work() const { return work_ / "costs.jsonl"; }
  void publish(const Manifest& manifest, std::size_t rows) const;

 private:
  void claim(bool resume);

  std::filesystem::path folder_, work_;
  std::string stem_;
  int lock_ = -1;
};

}  // namespace orchard::apps
