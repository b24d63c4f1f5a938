#include "batch/batch_run.h"

#include <fmt/format.h>

#include <system_error>

#include "command_line/interrupt.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {

BatchRun::BatchRun(const Manifest& manifest, const std::vector<std::size_t>& positions, const WorkerCommand& command,
                   const BatchFolder& folder, const BatchRunOptions& options, BatchProgress& progress)
    : manifest_(manifest),
      positions_(positions),
      command_(command),
      folder_(folder),
      options_(options),
      progress_(progress),
      rows_(folder.rows_in_work()),
      costs_(folder.costs_in_work()) {}

BatchCounts BatchRun::run() {
  while (next_ < positions_.size() || !jobs_.empty()) {
    throw_if_interrupted();
    progress_.draw();
    if (next_ < positions_.size() && jobs_.size() < options_.jobs) {
      start_next();
    } else {
      std::vector<const Worker*> workers;
      for (const Job& job : jobs_) workers.push_back(job.worker.get());
      wait_for_any(workers);
    }
    look_at_workers();
  }
  rows_.close();
  costs_.close();
  return counts_;
}

void BatchRun::start_next() {
  const std::size_t place = next_++;
  const BatchMesh& mesh = manifest_.meshes[positions_[place]];
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(mesh.file, error);
  if (!error && options_.limits.bytes > 0 && size > options_.limits.bytes) {
    // Such a file is not even read, because that may take an hour.
    const std::string key = fmt::format("unread {}", place);
    waiting_[key].push_back(place);
    return finish(key, refused_result("the file alone is larger than --memory allows", options_.limits), false);
  }
  std::string key;
  try {
    key = result_key(mesh.file, command_);
  } catch (const InputError& fault) {  // the file was removed after the batch began
    key = fmt::format("unread {}", place);
    waiting_[key].push_back(place);
    MeshResult result =
        refused_result("the file cannot be read any more; it was removed or its permissions changed", options_.limits);
    result.row["why"] = "error";
    result.lasting = false;
    return finish(key, result, false);
  }
  std::vector<std::size_t>& places = waiting_[key];
  places.push_back(place);
  if (places.size() > 1) return;  // the same file is being processed for another place
  const std::optional<MeshResult> known = folder_.find(key);
  if (known && !outgrown(*known, options_.limits)) return finish(key, *known, true);
  start(key, mesh);
}

void BatchRun::start(const std::string& key, const BatchMesh& mesh) {
  Job job{.key = key, .mesh = &mesh, .folder = folder_.begin(key), .worker = nullptr};
  const auto fault = options_.faults.find(mesh.name);
  const std::vector<std::string> words = fault == options_.faults.end()
                                             ? command_.words(mesh.file, job.folder)
                                             : std::vector<std::string>{"misbehave", fault->second};
  job.worker = std::make_unique<Worker>(words, options_.limits);
  jobs_.push_back(std::move(job));
}

void BatchRun::look_at_workers() {
  for (std::size_t i = 0; i < jobs_.size();) {
    const std::optional<WorkerEnd> end = jobs_[i].worker->look();
    if (!end) {
      ++i;
      continue;
    }
    const Job job = std::move(jobs_[i]);
    jobs_.erase(jobs_.begin() + static_cast<std::ptrdiff_t>(i));
    const MeshResult result =
        result_of(*end, command_.name, job.mesh->file, job.mesh->name, job.folder, options_.limits);
    folder_.finish(job.key, result, end->err);
    finish(job.key, result, false);
  }
}

// Writes the rows of all places that wait for the key.
void BatchRun::finish(const std::string& key, const MeshResult& result, bool known_before) {
  const std::string status = result.row["status"];
  const bool read = key.find(' ') == std::string::npos;
  for (const std::size_t place : waiting_[key]) {
    const std::size_t position = positions_[place];
    const std::string& name = manifest_.meshes[position].name;
    nlohmann::ordered_json row{
        {"index", position}, {"mesh", name}, {"key", read ? nlohmann::json(key) : nlohmann::json()}};
    row.update(result.row);
    nlohmann::ordered_json cost{{"index", position}, {"mesh", name}};
    cost.update(result.cost);
    rows_.add(place, row);
    costs_.add(place, cost);
    ++counts_.statuses[status];
    if (status == "failed") ++counts_.reasons[result.row["why"]];
    if (result.row["promise_kept"] == false) ++counts_.broken_promises;
    if (known_before) ++counts_.known_before;
    if (!result.lasting) counts_.not_lasting.push_back(name);
    progress_.add(!known_before, status == "failed");
  }
  waiting_.erase(key);
}

}  // namespace orchard::apps
