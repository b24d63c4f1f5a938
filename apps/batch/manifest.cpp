#include "batch/manifest.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <string_view>
#include <system_error>

#include "batch/sha256.h"
#include "command_line/text.h"
#include "input/input_file.h"
#include "input/mesh_input.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

std::vector<BatchMesh> listed(const fs::path& manifest) {
  std::ifstream in(manifest, std::ios::binary);
  std::vector<BatchMesh> meshes;
  for (std::string line; std::getline(in, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    if (line.find('\0') != std::string::npos)
      throw InputError(manifest.string() + ": this is no text with a path on each line, since it contains a zero byte");
    meshes.push_back({line, manifest.parent_path() / line});
  }
  if (in.bad() || !in.eof()) throw InputError(manifest.string() + ": the file cannot be read; check its permissions");
  if (meshes.empty()) throw InputError(manifest.string() + ": the file names no mesh; it needs a path on each line");
  return meshes;
}

std::vector<BatchMesh> found_in(const fs::path& folder, const fs::path& skipped) {
  std::vector<BatchMesh> meshes;
  std::error_code error, ignored;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::follow_directory_symlink, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->is_directory(ignored)) {
      if (!skipped.empty() && fs::equivalent(entry->path(), skipped, ignored)) entry.disable_recursion_pending();
    } else if (is_mesh_name(entry->path()) && entry->is_regular_file(ignored)) {
      meshes.push_back({entry->path().lexically_relative(folder).string(), entry->path()});
    }
  }
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  if (meshes.empty())
    throw InputError(folder.string() + ": the folder contains no mesh " + input_formats_in_words() +
                     ", and neither do the folders in it");
  std::sort(meshes.begin(), meshes.end(), [](const BatchMesh& a, const BatchMesh& b) { return a.name < b.name; });
  return meshes;
}

// Why a file cannot be a mesh of a batch; empty if it can.
std::string fault_of(const fs::path& file) {
  if (access(file.c_str(), R_OK) != 0) return std::generic_category().message(errno);
  std::error_code error;
  // Reading a device or a pipe might never end.
  if (!fs::is_regular_file(file, error)) return "it is no plain file";
  return is_mesh_name(file) ? "" : "its name is not that of a mesh " + input_formats_in_words();
}

void require_all(const fs::path& source, const std::vector<BatchMesh>& meshes) {
  std::vector<std::string> faults;
  for (const BatchMesh& mesh : meshes) {
    const std::string fault = fault_of(mesh.file);
    if (!fault.empty()) faults.push_back(mesh.name + " (" + fault + ")");
  }
  if (!faults.empty())
    throw InputError(fmt::format("{}: {} of {} meshes cannot be read, and none was begun: {}", source.string(),
                                 faults.size(), meshes.size(), joined(faults, ", ")));
}

bool parse_count(std::string_view text, std::size_t& count) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  return error == std::errc() && end == text.data() + text.size() && count >= 1;
}

}  // namespace

Manifest read_manifest(const fs::path& source, const fs::path& skipped) {
  std::error_code ignored;
  Manifest manifest;
  if (fs::is_directory(source, ignored)) {
    manifest.meshes = found_in(source, skipped);
  } else {
    check_input(source);
    if (is_mesh_name(source))
      throw InputError(source.string() +
                       ": this is a mesh; name a folder of meshes, or a file with a path on each line");
    if (!fs::is_regular_file(source, ignored))
      throw InputError(source.string() + ": this is neither a folder nor a file");
    manifest.meshes = listed(source);
  }
  require_all(source, manifest.meshes);
  Sha256 hash;
  for (const BatchMesh& mesh : manifest.meshes) hash.add(mesh.name + "\n");
  manifest.checksum = hash.hexadecimal();
  return manifest;
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  const std::size_t slash = text.find('/');
  const bool numbers = slash != std::string::npos &&
                       parse_count(std::string_view(text).substr(0, slash), shard.index) &&
                       parse_count(std::string_view(text).substr(slash + 1), shard.count);
  if (!numbers || shard.index > shard.count)
    throw InputError("--shard " + text + ": expected i/n with i from 1 to n, such as 1/4");
  return shard;
}

std::string stem_of(const Shard& shard) { return fmt::format("{}-of-{}", shard.index, shard.count); }

std::vector<std::size_t> positions_of(const Shard& shard, std::size_t meshes) {
  std::vector<std::size_t> positions;
  for (std::size_t at = shard.index - 1; at < meshes; at += shard.count) positions.push_back(at);
  return positions;
}

}  // namespace orchard::apps
