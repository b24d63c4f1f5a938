#pragma once
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace orchard::apps {

struct Request;

// The command that a batch runs for every mesh: `orchard build|medial|spheres MESH -o FOLDER OPTIONS`.
struct WorkerCommand {
  std::string name;                  // build, medial or spheres
  std::vector<std::string> options;  // as typed
  // The part of the options that decides the results, in a normal form (provenance.h).
  std::string decisive;
  nlohmann::json decisive_options;
  bool own_threads = false;                // whether the options state a number of threads
  std::shared_ptr<const Request> request;  // the parsed options, as the command would see them

  // Returns the arguments of the program for one mesh.
  std::vector<std::string> words(const std::filesystem::path& mesh, const std::filesystem::path& folder) const;
};

// words: a command and its options. Throws InputError if they are not those of such a command, contradict each other,
// or belong to a single mesh or to the way a batch calls the command (-o, --json, ..).
WorkerCommand parse_worker_command(const std::vector<std::string>& words);

}  // namespace orchard::apps
