#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace orchard::apps {

// The rows of all shards of a batch.
struct MergedRows {
  nlohmann::json description;      // what batch.json says
  std::vector<std::string> lines;  // JSON objects in the manifest's order
  std::vector<std::string> costs;  // likewise
  std::size_t shards = 0;
};

// folders: of one batch, whose shards may be spread over them. Where several sets of shards are complete, as 1/1 beside
// 1/4 to 4/4, the one of the fewest shards counts. Throws InputError if a folder is none of a batch, if they are of
// different options or manifests, or if shards are missing: the message names them.
MergedRows read_merged_rows(const std::vector<std::filesystem::path>& folders);

}  // namespace orchard::apps
