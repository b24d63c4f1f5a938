#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

// Where files come from. Every file that a command writes says it in the place that its format has for it (stamp.h), in
// the same words: the program's version, the inputs, the options, the seed and the command line. None of that depends
// on folders, threads or the time, so that the same input, options and seed still give the same bytes. Only the reports
// (.json), which hold times anyway, say where the inputs were and what exactly was typed.
namespace orchard::apps {

// Version of the keys of reports. It rises when a key is renamed, removed or changes its meaning;
// docs/reference/reports.schema.json describes this version.
inline constexpr int kSchemaVersion = 3;

// What the user asked for.
struct Invocation {
  std::string typed;         // the whole command line
  std::string command_line;  // what of it decides what files hold, in the order of --help, files without their folders
  nlohmann::json options = nlohmann::json::object();  // of that, the options by their long names, as they were given
  std::optional<std::uint64_t> seed;                  // of commands that have one
};

// Precondition: `command` has been parsed.
Invocation invocation_of(const CLI::App& command, const std::string& typed);

struct ProvenanceInput {
  std::filesystem::path path;  // absolute
  std::string checksum;        // FNV-1a of its bytes, 64 bits as hexadecimal digits
};

struct Provenance {
  Invocation run;
  std::vector<ProvenanceInput> inputs;  // the one that files are named for comes first; may be empty
};

// The checksum of one file. Throws InputError if it cannot be read.
std::string checksum_of(const std::filesystem::path& file);

// Reads every input once. Throws InputError if one cannot be read.
Provenance provenance_of(const Invocation& run, std::span<const std::filesystem::path> inputs);

// What all files say: one line of ASCII characters, "orchard {..}", with JSON in the braces.
std::string line_of(const Provenance& provenance);
// The same as an object.
nlohmann::json decisive_json(const Provenance& provenance);
// The provenance of reports: also the schema version and, under "run", the inputs' paths and what was typed.
nlohmann::json to_json(const Provenance& provenance);

// What an earlier run's report says about itself.
struct RecordedRun {
  std::filesystem::path input;  // the first one's path
  std::string checksum, command_line;
};
// Nothing where there is no such report, or where it does not say: another program wrote it, or an older version.
std::optional<RecordedRun> read_recorded(const std::filesystem::path& report);

// Whether the first inputs differ both in place and in content. An input that was edited since, and a copy of it, are
// the same one.
bool is_of_another_input(const RecordedRun& recorded, const Provenance& provenance);

}  // namespace orchard::apps
