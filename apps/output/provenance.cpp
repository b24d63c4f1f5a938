#include "output/provenance.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <iterator>
#include <system_error>

#include "command_line/text.h"
#include "input/standard_input.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kStandardInput = "-";

fs::path whole_path(const fs::path& file) {
  if (is_standard_input(file)) return kStandardInput;
  std::error_code failure;
  fs::path whole = fs::weakly_canonical(file, failure);
  return failure ? fs::absolute(file).lexically_normal() : whole;
}

// Names that are no UTF-8 must not keep a report from being written.
std::string dumped(const json& value, int indent = -1) {
  return value.dump(indent, ' ', true, json::error_handler_t::replace);
}

}  // namespace

std::string checksum_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 65536> piece{};
  std::uint64_t hash = 0xcbf29ce484222325u;
  while (in.read(piece.data(), piece.size()), in.gcount() > 0)
    for (std::streamsize i = 0; i < in.gcount(); ++i)
      hash = (hash ^ static_cast<unsigned char>(piece[static_cast<std::size_t>(i)])) * 0x100000001b3u;
  if (in.bad() || !in.eof()) throw InputError(file.string() + ": the file cannot be read; check its permissions");
  return fmt::format("{:016x}", hash);
}

Provenance provenance_of(const Invocation& run, std::span<const fs::path> inputs) {
  Provenance provenance{.run = run, .inputs = {}};
  for (const fs::path& input : inputs) provenance.inputs.push_back({whole_path(input), checksum_of(input)});
  return provenance;
}

json decisive_json(const Provenance& provenance) {
  json inputs = json::array();
  for (const ProvenanceInput& input : provenance.inputs)
    inputs.push_back({{"file", input.path.filename().string()}, {"checksum", input.checksum}});
  json result{{"version", ORCHARD_VERSION},
              {"command_line", provenance.run.command_line},
              {"inputs", std::move(inputs)},
              {"options", provenance.run.options}};
  if (provenance.run.seed) result["seed"] = *provenance.run.seed;
  return json::parse(dumped(result));
}

std::string line_of(const Provenance& provenance) {
  // XML's processing instructions end with "?>", wherever that is.
  return "orchard " + replaced(dumped(decisive_json(provenance)), "?>", "?\\u003e");
}

json to_json(const Provenance& provenance) {
  json result = decisive_json(provenance);
  result["schema_version"] = kSchemaVersion;
  json paths = json::array();
  for (const ProvenanceInput& input : provenance.inputs) paths.push_back(input.path.string());
  result["run"] = {{"typed", provenance.run.typed}, {"paths", std::move(paths)}};
  return json::parse(dumped(result));
}

std::optional<RecordedRun> read_recorded(const fs::path& report) {
  std::ifstream in(report, std::ios::binary);
  const json parsed = json::parse(in, nullptr, false);
  try {
    const json& provenance = parsed.at("provenance");
    return RecordedRun{provenance.at("run").at("paths").at(0).get<std::string>(),
                       provenance.at("inputs").at(0).at("checksum").get<std::string>(),
                       provenance.at("command_line").get<std::string>()};
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

bool is_of_another_input(const RecordedRun& recorded, const Provenance& provenance) {
  if (provenance.inputs.empty()) return false;
  const ProvenanceInput& input = provenance.inputs.front();
  std::error_code ignored;
  if (input.path == kStandardInput) return recorded.checksum != input.checksum;
  const bool same_place = recorded.input == input.path || fs::equivalent(recorded.input, input.path, ignored);
  return !same_place && recorded.checksum != input.checksum;
}

}  // namespace orchard::apps
