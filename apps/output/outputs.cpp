#include "output/outputs.h"

#include <fmt/core.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "input/input_file.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "output/stamp.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

// Makes the folders that do not exist, and returns them, the outermost first. Sets `error` if that fails.
std::vector<fs::path> make_folders(const fs::path& folder, std::error_code& error) {
  std::vector<fs::path> made;
  fs::path whole;
  for (const fs::path& part : folder) {
    whole /= part;
    if (part.empty() || !fs::create_directory(whole, error)) {
      if (error) break;
      continue;
    }
    made.push_back(whole);
  }
  if (!error && !folder.empty() && !fs::is_directory(folder, error) && !error)
    error = std::make_error_code(std::errc::not_a_directory);
  return made;
}

// Only those that are empty.
void remove_folders(const std::vector<fs::path>& made) {
  std::error_code ignored;
  for (auto folder = made.rbegin(); folder != made.rend(); ++folder) fs::remove(*folder, ignored);
}

// A new, empty folder in another one; empty if that cannot be written to, for the reason in errno.
fs::path make_staging(const fs::path& folder) {
  std::string name = (folder / ".orchard-XXXXXX").string();
  return mkdtemp(name.data()) == nullptr ? fs::path() : fs::path(name);
}

std::string reason(int number) { return std::generic_category().message(number); }

void check_file(const fs::path& file, std::span<const fs::path> inputs) {
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (!fs::exists(status)) return;
  if (fs::is_directory(status))
    throw InputError(
        file.string() +
        ": the file cannot be written because a folder has this name; rename that or choose another place");
  for (const fs::path& input : inputs)
    if (fs::equivalent(file, input, ignored))
      throw InputError(file.string() + ": the command reads this file and would overwrite it; choose another place");
  if (access(file.c_str(), W_OK) != 0)
    throw InputError(file.string() + ": cannot be written: " + reason(errno) + "; remove it or choose another place");
}

// Returns the report of the run whose files are there, if these may be replaced.
std::optional<RecordedRun> check_owner(const Destination& destination) {
  const fs::path report = destination.folder / destination.report;
  std::optional<RecordedRun> recorded = read_recorded(report);
  if (recorded && !destination.force && is_of_another_input(*recorded, destination.provenance))
    throw InputError(
        fmt::format("{}: it and the files beside it are those of {}, and the input is {}; choose another folder with "
                    "-o, or replace "
                    "them with --force",
                    report.string(), recorded->input.string(), destination.provenance.inputs.front().path.string()));
  return recorded;
}

}  // namespace

std::string named(const fs::path& model, const std::string& ending) { return model.stem().string() + ending; }

std::string file_ending(const fs::path& output, std::span<const std::string> endings) {
  const std::string ending = lower_extension(output);
  std::error_code ignored;
  const bool known = std::find(endings.begin(), endings.end(), ending) != endings.end();
  return known && !fs::is_directory(output, ignored) ? ending : std::string();
}

void keep_single_file(Destination& destination, std::span<const std::string> names) {
  std::vector<std::string> endings;
  for (const std::string& name : names) endings.push_back(fs::path(name).extension().string());
  const std::string ending = file_ending(destination.folder, endings);
  if (ending.empty()) return;
  const auto found = std::find(endings.begin(), endings.end(), ending) - endings.begin();
  destination.single = names[static_cast<std::size_t>(found)];
  destination.single_as = destination.folder.filename().string();
  destination.folder = destination.folder.has_parent_path() ? destination.folder.parent_path() : fs::path(".");
}

void check_outputs(const Destination& destination, std::span<const std::string> names,
                   std::span<const fs::path> inputs) {
  const fs::path& folder = destination.folder;
  if (!destination.single.empty()) return check_output(folder / destination.single_as, inputs);
  if (folder.empty()) throw InputError("-o: the name of the folder is empty; give \".\" for the current one");
  const Writing writing;
  std::error_code error;
  const std::vector<fs::path> made = make_folders(folder, error);
  const fs::path probe = error ? fs::path() : make_staging(folder);
  const int number = errno;
  std::error_code ignored;
  if (!probe.empty()) fs::remove(probe, ignored);
  remove_folders(made);
  if (error)
    throw InputError(folder.string() + ": cannot be made a folder: " + error.message() + "; choose another with -o");
  if (probe.empty())
    throw InputError(folder.string() + ": cannot be written to: " + reason(number) + "; choose another folder with -o");
  for (const std::string& name : names) check_file(folder / name, inputs);
  check_file(folder / destination.report, inputs);
  check_owner(destination);
}

void check_output(const fs::path& file, std::span<const fs::path> inputs) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored))
    throw InputError(file.string() + ": cannot be written: there is no folder " + folder.string());
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(file.string() + ": cannot be written: " + folder.string() + ": " + reason(errno));
  check_file(file, inputs);
}

Outputs::Outputs(Destination destination) : destination_(std::move(destination)) {
  const fs::path& folder = destination_.folder;
  std::error_code error;
  made_ = make_folders(folder, error);
  if (!error) staging_ = make_staging(folder);
  if (!staging_.empty()) return;
  const std::string why = error ? error.message() : reason(errno);
  remove_folders(made_);
  throw Error(folder.string() + ": cannot be written to: " + why);
}

Outputs::~Outputs() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  remove_folders(made_);
}

fs::path Outputs::add(const std::string& name, const std::string& what) {
  throw_if_interrupted();
  files_.emplace_back(name, what);
  return staging_ / name;
}

std::string Outputs::take(const std::string& name, bool keep) {
  std::error_code ignored;
  if (!fs::is_regular_file(staging_ / name, ignored)) return {};
  std::string bytes = content_of(staging_ / name);
  if (keep) return bytes;
  fs::remove(staging_ / name, ignored);
  std::erase_if(files_, [&](const auto& file) { return file.first == name; });
  return bytes;
}

void Outputs::add_report(nlohmann::json& report, const std::string& what) {
  report["provenance"] = to_json(destination_.provenance);
  write_file(add(destination_.report, what), report.dump(2) + "\n");
}

void Outputs::commit() {
  throw_if_interrupted();
  const fs::path& folder = destination_.folder;
  if (!destination_.single.empty()) return commit_single();
  replaced_ = check_owner(destination_);
  const std::string line = line_of(destination_.provenance);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(staging_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) stamp(staging_ / name, line);
  // Renaming fails halfway only if another program changes the folder meanwhile.
  for (const std::string& name : names) check_file(folder / name, {});
  for (const std::string& name : names) {
    std::error_code error;
    fs::rename(staging_ / name, folder / name, error);
    if (error) throw Error((folder / name).string() + ": cannot be replaced: " + error.message());
  }
  fs::remove(staging_);
}

void Outputs::commit_single() {
  const fs::path from = staging_ / destination_.single, to = destination_.folder / destination_.single_as;
  std::error_code error;
  if (!fs::exists(from, error))
    throw InputError(to.string() + ": these options write no file of this kind; name a folder with -o to see which");
  stamp(from, line_of(destination_.provenance));
  fs::rename(from, to, error);
  if (error) throw Error(to.string() + ": cannot be written: " + error.message());
  fs::remove_all(staging_, error);
}

fs::path Outputs::place_of(const std::string& name) const {
  return destination_.folder / (name == destination_.single ? destination_.single_as : name);
}

void Outputs::print() const {
  for (const auto& [name, what] : files_)
    if (!what.empty() && (destination_.single.empty() || name == destination_.single))
      fmt::print("  {}  ({})\n", place_of(name).string(), what);
  if (replaced_ && replaced_->command_line != destination_.provenance.run.command_line)
    fmt::print("they replace those of: {}\n", replaced_->command_line);
}

}  // namespace orchard::apps
