#pragma once
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace orchard::apps {

struct Request;

// What a batch does with every mesh: `orchard build|medial|spheres MESH -o FOLDER OPTIONS`.
struct WorkerCommand {
  std::string name;                  // build, medial or spheres
  std::vector<std::string> options;  // as typed
  // What of them decides the results, in the words of provenance.h: the same for all ways to type the same.
  std::string decisive;
  nlohmann::json decisive_options;
  bool own_threads = false;                // the options say how many
  std::shared_ptr<const Request> request;  // as the command itself would see them

  // The program's words for one mesh.
  std::vector<std::string> words(const std::filesystem::path& mesh, const std::filesystem::path& folder) const;
};

// words: a command and its options. Throws InputError if they are not those of such a command, contradict each other,
// or belong to a single mesh or to the way a batch calls the command (-o, --json, ..).
WorkerCommand parse_worker_command(const std::vector<std::string>& words);

}  // namespace orchard::apps
