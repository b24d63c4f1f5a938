#include "batch/merged_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <utility>

#include "batch/batch_folder.h"
#include "batch/manifest.h"
#include "command_line/text.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct ShardFiles {
  fs::path folder;
  std::size_t meshes = 0, rows = 0;
};

// All shards of a number of shards and a manifest, by their index.
using ShardSets = std::map<std::pair<std::size_t, std::string>, std::map<std::size_t, ShardFiles>>;

json object_in(const fs::path& file) {
  std::ifstream in(file);
  json found = json::parse(in, nullptr, false);
  if (!found.is_object()) throw InputError(file.string() + ": this is not what a batch wrote; run the shard again");
  return found;
}

// "3-of-8" of "3-of-8.json".
Shard shard_of(const fs::path& file) { return parse_shard(replaced(file.stem().string(), "-of-", "/")); }

void add_shards(const fs::path& folder, ShardSets& sets) {
  for (const auto& entry : fs::directory_iterator(folder / "shards")) {
    if (entry.path().extension() != ".json") continue;
    const Shard shard = shard_of(entry.path());
    const json said = object_in(entry.path());
    if (!fs::exists(fs::path(entry.path()).replace_extension(".jsonl"))) continue;
    sets[{shard.count, said.value("manifest", "")}][shard.index] = {
        entry.path().parent_path(), said.value("meshes", std::size_t{0}), said.value("rows", std::size_t{0})};
  }
}

std::string missing_in(const ShardSets& sets) {
  std::vector<std::string> sentences;
  for (const auto& [set, shards] : sets) {
    std::vector<std::string> missing;
    for (std::size_t i = 1; i <= set.first && missing.size() < 20; ++i)
      if (!shards.contains(i)) missing.push_back(fmt::format("{}/{}", i, set.first));
    sentences.push_back(fmt::format("of {} shards {} are there, missing are {}{}", set.first, shards.size(),
                                    joined(missing, ", "), set.first - shards.size() > missing.size() ? ", .." : ""));
  }
  return sentences.empty() ? "no shard has run to its end" : joined(sentences, "; ");
}

// The set with all its shards, of the fewest.
ShardSets::const_iterator complete_set(const fs::path& folder, const ShardSets& sets) {
  auto chosen = sets.end();
  std::set<std::string> manifests;
  for (auto set = sets.begin(); set != sets.end(); ++set) {
    if (set->second.size() != set->first.first) continue;
    if (chosen == sets.end()) chosen = set;
    manifests.insert(set->first.second);
  }
  if (chosen == sets.end())
    throw InputError(
        fmt::format("{}: cannot be merged: {}; run them with --resume", folder.string(), missing_in(sets)));
  if (manifests.size() > 1)
    throw InputError(folder.string() +
                     ": the folder has shards of two manifests; run all shards of the present one with --resume, "
                     "and remove the others from the folder named shards");
  return chosen;
}

// Each line at the place that its index says.
std::vector<std::string> lines_by_index(const std::map<std::size_t, ShardFiles>& shards, std::size_t count,
                                        const char* ending) {
  std::vector<std::string> lines;
  for (const auto& [index, files] : shards) {
    lines.resize(std::max(lines.size(), files.meshes));
    const fs::path file = files.folder / (stem_of({index, count}) + ending);
    std::ifstream in(file);
    std::size_t rows = 0, place = index - 1;
    for (std::string line; std::getline(in, line); place += count, ++rows) {
      const json row = json::parse(line, nullptr, false);
      if (!row.is_object() || row.value("index", lines.size()) != place || place >= lines.size())
        throw InputError(fmt::format("{}: line {} is not the row of mesh {}; run the shard again with --resume",
                                     file.string(), rows + 1, place));
      lines[place] = std::move(line);
    }
    if (rows != files.rows)
      throw InputError(
          fmt::format("{}: has {} rows of {}; run the shard again with --resume", file.string(), rows, files.rows));
  }
  return lines;
}

}  // namespace

MergedRows read_merged_rows(const std::vector<fs::path>& folders) {
  MergedRows merged;
  ShardSets sets;
  for (const fs::path& folder : folders) {
    if (!fs::exists(folder / kBatchFile))
      throw InputError(folder.string() + ": this is no folder of orchard batch, since it has no file " + kBatchFile);
    const json description = object_in(folder / kBatchFile);
    if (merged.description.is_null()) merged.description = description;
    if (merged.description != description)
      throw InputError(fmt::format(
          "{} and {}: were made with different options: \"{}\" and \"{}\"", folders.front().string(), folder.string(),
          merged.description.value("command_line", "?"), description.value("command_line", "?")));
    if (fs::is_directory(folder / "shards")) add_shards(folder, sets);
  }
  const auto set = complete_set(folders.front(), sets);
  merged.shards = set->first.first;
  merged.lines = lines_by_index(set->second, merged.shards, ".jsonl");
  merged.costs = lines_by_index(set->second, merged.shards, ".costs.jsonl");
  return merged;
}

}  // namespace orchard::apps
