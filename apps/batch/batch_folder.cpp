#include "batch/batch_folder.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <system_error>
#include <thread>

#include "batch/sha256.h"
#include "command_line/interrupt.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kRow = "row.json";
constexpr const char* kCost = "cost.json";
constexpr const char* kLog = "log.txt";
constexpr std::chrono::milliseconds kBetweenTries{100};

// Text that is not valid UTF-8 must not prevent a row from being written.
template <class Json>
std::string line_of(const Json& value) {
  return value.dump(-1, ' ', true, json::error_handler_t::replace) + "\n";
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(folder.string() + ": cannot be made: " + error.message());
}

// Moves a file to a place that must not exist yet. Returns whether that succeeded.
bool moved(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (!error) return true;
  if (fs::exists(to)) return false;
  throw Error(to.string() + ": cannot be made: " + error.message());
}

fs::path place_in(const fs::path& folder, const std::string& key) {
  return folder / "results" / key.substr(0, 2) / key;
}

void require_same(const fs::path& folder, const json& wanted) {
  const fs::path file = folder / kBatchFile;
  if (!fs::exists(file)) return write_file(file, wanted.dump(2) + "\n");
  std::ifstream in(file);
  const json found = json::parse(in, nullptr, false);
  if (found == wanted) return;
  if (!found.is_object() || !found.contains("command_line"))
    throw InputError(file.string() +
                     ": does not say which options this folder's results are made with; choose another folder");
  throw InputError(
      fmt::format("{}: was made by version {} with \"{}\", and this is version {} with \"{}\"; choose another "
                  "folder, or the same options",
                  folder.string(), found.value("version", "?"), found.value("command_line", "?"),
                  wanted.value("version", ""), wanted.value("command_line", "")));
}

}  // namespace

std::string result_key(const fs::path& mesh, const WorkerCommand& worker) {
  std::ifstream in(mesh, std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 20);
  Sha256 hash;
  // The name is part of the key because results contain it, in the names of files, of robots' links and in the
  // provenance.
  hash.add(line_of(json{batch_description(worker), mesh.filename().string()}));
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())), in.gcount() > 0) {
    hash.add({piece.data(), static_cast<std::size_t>(in.gcount())});
    throw_if_interrupted();
  }
  if (in.bad() || !in.eof()) throw InputError(mesh.string() + ": the file cannot be read; check its permissions");
  return hash.hexadecimal();
}

json batch_description(const WorkerCommand& worker) {
  return {{"version", ORCHARD_VERSION}, {"command_line", worker.decisive}, {"options", worker.decisive_options}};
}

BatchFolder::BatchFolder(fs::path folder, const Shard& shard, const WorkerCommand& worker, bool resume)
    : folder_(std::move(folder)), work_(folder_ / ".work" / stem_of(shard)), stem_(stem_of(shard)) {
  std::error_code ignored;
  if (fs::exists(folder_, ignored) && !fs::is_directory(folder_, ignored))
    throw InputError(folder_.string() + ": this is no folder; choose another place with -o");
  fs::create_directories(folder_ / "results", ignored);
  if (access((folder_ / "results").c_str(), W_OK | X_OK) != 0)
    throw InputError(folder_.string() + ": cannot be written to: " + std::generic_category().message(errno) +
                     "; choose another place with -o");
  require_same(folder_, batch_description(worker));
  make_folder(folder_ / "shards");
  claim(resume);
  fs::remove_all(work_, ignored);
  make_folder(work_);
}

BatchFolder::~BatchFolder() {
  std::error_code ignored;
  fs::remove_all(work_, ignored);
  fs::remove(work_.parent_path(), ignored);  // succeeds only if no other shard is running
  close(lock_);
}

void BatchFolder::claim(bool resume) {
  const fs::path file = folder_ / "shards" / (stem_ + ".lock");
  if (!resume && fs::exists(file))
    throw InputError(
        fmt::format("{}: shard {} was begun here before; give --resume to finish it", folder_.string(), stem_));
  lock_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) throw Error(file.string() + ": cannot be written: " + std::generic_category().message(errno));
  for (bool told = false; flock(lock_, LOCK_EX | LOCK_NB) != 0; told = true) {
    if (errno != EWOULDBLOCK && errno != EINTR)
      throw Error(file.string() + ": cannot be locked: " + std::generic_category().message(errno));
    if (!told) fmt::print(stderr, "orchard: another process runs shard {}; waiting for it to end\n", stem_);
    std::this_thread::sleep_for(kBetweenTries);
    throw_if_interrupted();
  }
}

std::optional<MeshResult> BatchFolder::find(const std::string& key) const {
  const fs::path place = place_in(folder_, key);
  std::ifstream row(place / kRow), cost(place / kCost);
  MeshResult result{.row = nlohmann::ordered_json::parse(row, nullptr, false),
                    .cost = nlohmann::ordered_json::parse(cost, nullptr, false)};
  if (!result.row.is_object() || !result.cost.is_object()) return std::nullopt;
  return result;
}

fs::path BatchFolder::begin(const std::string& key) const {
  fs::path place = work_ / key;
  make_folder(place);
  return place;
}

void BatchFolder::finish(const std::string& key, const MeshResult& result, const std::string& log) const {
  const fs::path made = work_ / key, place = place_in(folder_, key);
  if (!result.lasting) {
    fs::remove_all(made);
    return;
  }
  // A worker that was killed leaves unfinished files behind.
  if (result.row["status"] == "failed")
    for (const auto& entry : fs::directory_iterator(made)) fs::remove_all(entry);
  write_file(made / kRow, line_of(result.row));
  write_file(made / kCost, line_of(result.cost));
  write_file(made / kLog, log);
  make_folder(place.parent_path());
  if (moved(made, place)) return;
  const std::optional<MeshResult> there = find(key);
  const bool better = !there || (there->row["status"] == "failed" && there->row["why"] != "refused");
  if (!better) {
    fs::remove_all(made);  // another shard has the same mesh and was faster
    return;
  }
  const fs::path older = work_ / (key + "-older");
  moved(place, older);
  if (!moved(made, place)) fs::remove_all(made);
  fs::remove_all(older);
}

void BatchFolder::publish(const Manifest& manifest, std::size_t rows) const {
  const fs::path shards = folder_ / "shards";
  // The costs come first, and last the file that marks the shard as complete.
  fs::rename(costs_in_work(), shards / (stem_ + ".costs.jsonl"));
  write_file(shards / (stem_ + ".json"),
             json{{"manifest", manifest.checksum}, {"meshes", manifest.meshes.size()}, {"rows", rows}}.dump() + "\n");
  fs::rename(rows_in_work(), shards / (stem_ + ".jsonl"));
}

}  // namespace orchard::apps
