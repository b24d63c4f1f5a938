#include "outputs.h"

#include <fmt/core.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

// Folders that do not exist, the outermost first; makes them. Sets `error` if that cannot be.
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
    throw InputError(file.string() + ": cannot be written, it is a folder; rename it or choose another place");
  for (const fs::path& input : inputs)
    if (fs::equivalent(file, input, ignored))
      throw InputError(file.string() + ": would be written over, but is what the command reads; choose another place");
  if (access(file.c_str(), W_OK) != 0)
    throw InputError(file.string() + ": cannot be written: " + reason(errno) + "; remove it or choose another place");
}

}  // namespace

std::string named(const fs::path& model, const std::string& ending) { return model.stem().string() + ending; }

void check_outputs(const fs::path& folder, std::span<const std::string> names, std::span<const fs::path> inputs) {
  if (folder.empty()) throw InputError("-o: the folder's name is empty; \".\" is the one that you are in");
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

Outputs::Outputs(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  made_ = make_folders(folder_, error);
  if (!error) staging_ = make_staging(folder_);
  if (!staging_.empty()) return;
  const std::string why = error ? error.message() : reason(errno);
  remove_folders(made_);
  throw Error(folder_.string() + ": cannot be written to: " + why);
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

void Outputs::commit() {
  throw_if_interrupted();
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(staging_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  // Renaming fails halfway only if someone changes the folder meanwhile.
  for (const std::string& name : names) check_file(folder_ / name, {});
  for (const std::string& name : names) {
    std::error_code error;
    fs::rename(staging_ / name, folder_ / name, error);
    if (error) throw Error((folder_ / name).string() + ": cannot be replaced: " + error.message());
  }
  fs::remove(staging_);
}

void Outputs::print() const {
  for (const auto& [name, what] : files_)
    if (!what.empty()) fmt::print("  {}  ({})\n", (folder_ / name).string(), what);
}

}  // namespace orchard::apps
