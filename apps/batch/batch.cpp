#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <thread>

#include "batch/batch_cost.h"
#include "batch/batch_merge.h"
#include "batch/batch_run.h"
#include "command_line/commands.h"
#include "command_line/console.h"
#include "command_line/interrupt.h"
#include "command_line/text.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostNames = 10;  // the number of names in one message

bool is_given(const BatchCommand& command, const std::string& option) {
  return std::find(command.given.begin(), command.given.end(), option) != command.given.end();
}

void refuse(const BatchCommand& command, std::initializer_list<const char*> options, const std::string& beside) {
  for (const char* option : options)
    if (is_given(command, option)) throw InputError(fmt::format("batch: --{} has no effect with {}", option, beside));
}

std::map<std::string, std::string> faults_of(const BatchCommand& command) {
  std::map<std::string, std::string> faults;
  for (const std::string& fault : command.faults) {
    const std::size_t equals = fault.find('=');
    if (equals == std::string::npos) throw InputError("--fault " + fault + ": expected KIND=MESH");
    faults[fault.substr(equals + 1)] = fault.substr(0, equals);
  }
  return faults;
}

BatchRunOptions options_of(const BatchCommand& command) {
  const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
  return {.jobs = command.jobs > 0 ? static_cast<std::size_t>(command.jobs) : threads,
          .limits = {.seconds = command.timeout, .bytes = static_cast<std::uint64_t>(command.memory) << 20},
          .faults = faults_of(command)};
}

json counts_json(const BatchCounts& counts, double seconds) {
  return {{"statuses", counts.statuses},           {"failures", counts.reasons},
          {"known_before", counts.known_before},   {"promises_not_kept", counts.broken_promises},
          {"to_be_run_again", counts.not_lasting}, {"seconds", seconds}};
}

void print_batch(const BatchCommand& command, const Shard& shard, std::size_t meshes, const BatchCounts& counts,
                 double seconds) {
  std::vector<std::string> parts;
  for (const auto& [status, count] : counts.statuses) parts.push_back(fmt::format("{} {}", count, status));
  fmt::print("{} meshes{}: {}; {} known before, {:.1f} s\n", meshes,
             shard.count > 1 ? fmt::format(" of shard {}/{}", shard.index, shard.count) : "", joined(parts, ", "),
             counts.known_before, seconds);
  for (const auto& [why, count] : counts.reasons) fmt::print("  failed: {:<10} {}\n", why, count);
  if (counts.broken_promises > 0) fmt::print("  promise not kept:  {}\n", counts.broken_promises);
  fmt::print("  {}  (a row a mesh)\n", (command.folder / "shards" / (stem_of(shard) + ".jsonl")).string());
}

ExitCode finish(const BatchCounts& counts) {
  if (counts.not_lasting.empty()) return kSucceeded;
  std::vector<std::string> names = counts.not_lasting;
  const bool many = names.size() > kMostNames;
  if (many) names.resize(kMostNames);
  fmt::print(stderr,
             "orchard: batch: {} meshes failed through no fault of their own; run it again with --resume: {}{}\n",
             counts.not_lasting.size(), joined(names, ", "), many ? ", .." : "");
  return kFailed;
}

}  // namespace

ExitCode batch(const BatchCommand& command) {
  if (command.sources.front() == "merge") {
    refuse(command, {"shard", "jobs", "timeout", "memory", "resume", "cost"}, "merge");
    merge_batches(command);
    return kSucceeded;
  }
  if (command.sources.size() > 1) throw InputError("batch: name one folder or manifest, and the command after --");
  if (command.cost) refuse(command, {"output", "timeout", "memory", "resume"}, "--cost");
  if (!command.cost && command.folder.empty())
    throw InputError("batch: --output is required: the folder for the results");
  const WorkerCommand worker = parse_worker_command(command.worker);
  const Shard shard = parse_shard(command.shard);
  const BatchRunOptions options = options_of(command);
  const Manifest manifest = read_manifest(command.sources.front(), command.folder);
  if (command.cost) {
    print_batch_cost(command, worker, manifest, shard);
    return kSucceeded;
  }
  const Writing writing;
  const BatchFolder folder(command.folder, shard, worker, command.resume);
  const std::vector<std::size_t> positions = positions_of(shard, manifest.meshes.size());
  const bool talk = !command.output.quiet && !command.output.json;
  const Stopwatch clock;
  BatchProgress progress(positions.size(), talk);
  const BatchCounts counts = BatchRun(manifest, positions, worker, folder, options, progress).run();
  folder.publish(manifest, positions.size());
  progress.clear();
  if (command.output.json) fmt::print("{}\n", counts_json(counts, clock.seconds()).dump(2));
  if (talk) print_batch(command, shard, positions.size(), counts, clock.seconds());
  return finish(counts);
}

}  // namespace orchard::apps
