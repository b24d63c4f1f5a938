#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "interrupt.h"

// The files that a command writes. Each has the model and, where several commands would want the name, the command in
// its own, so that runs on several models and of several commands share a folder.
namespace orchard::apps {

inline constexpr const char* kWrapEnding = "-wrap.obj";          // of the wrap that a tree was built on
inline constexpr const char* kRepairedEnding = "-repaired.obj";  // of the mesh that repair made and it was built on

// NAME-OF-MODEL + ending.
std::string named(const std::filesystem::path& model, const std::string& ending);

// For the beginning of a command, before it works for long: throws InputError if the folder cannot be made or written
// to, if one of `names` in it is something that cannot be replaced, or is one of `inputs`. Leaves nothing behind.
void check_outputs(const std::filesystem::path& folder, std::span<const std::string> names,
                   std::span<const std::filesystem::path> inputs);

// The same for a single file.
void check_output(const std::filesystem::path& file, std::span<const std::filesystem::path> inputs);

// Files that appear in their folder all together, and only if everything went well: they are written to a folder of
// their own, `.orchard-XXXXXX` inside the other, and moved at the end. An error or a signal before that leaves nothing
// behind, and whatever an earlier run wrote as it was. Throws Error if the folder cannot be made.
class Outputs {
 public:
  explicit Outputs(std::filesystem::path folder);
  ~Outputs();
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  // Where to write a file until commit(), and what to tell the user about it; nothing: it goes without saying. Throws
  // Cancelled after a signal.
  std::filesystem::path add(const std::string& name, const std::string& what = {});

  // The same without a word, for what may not succeed.
  std::filesystem::path staged(const std::string& name) const { return staging_ / name; }

  // Where commit() puts it.
  std::filesystem::path place_of(const std::string& name) const { return folder_ / name; }

  // Moves everything, each file in place of an older one of its name. Throws Error.
  void commit();

  // A line for each file that has something to tell.
  void print() const;

 private:
  std::filesystem::path folder_, staging_;
  std::vector<std::filesystem::path> made_;  // folders that did not exist, the outermost first
  std::vector<std::pair<std::string, std::string>> files_;
  Writing writing_;
};

}  // namespace orchard::apps
