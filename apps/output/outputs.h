#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command_line/interrupt.h"
#include "output/provenance.h"

// The files that a command writes. Each has the model and, where several commands would want the name, the command in
// its own, so that runs on several models and of several commands share a folder.
namespace orchard::apps {

inline constexpr const char* kWrapEnding = "-wrap.obj";          // of the wrap that a tree was built on
inline constexpr const char* kRepairedEnding = "-repaired.obj";  // of the mesh that repair made and it was built on
inline constexpr const char* kClippedEnding = "-clipped.obj";    // of the part of the mesh that a plane leaves

// NAME-OF-MODEL + ending.
std::string named(const std::filesystem::path& model, const std::string& ending);

// Where a command's files go, and whose they are.
struct Destination {
  std::filesystem::path folder;
  std::string report;          // the name of the JSON report beside them, by which a later run knows whose they are
  Provenance provenance;       // which all of them carry
  bool force = false;          // replace files of another input
  std::string single = {};     // not empty: of all files, this one alone is kept
  std::string single_as = {};  // then its name in the folder
};

// The ending of `output` if -o names a file and not a folder: one of `endings`, such as ".ma", and no folder of this
// name is there. Else empty.
std::string file_ending(const std::filesystem::path& output, std::span<const std::string> endings);

// Where the folder of a destination is the name of a file with the ending of one of `names`, the files that a command
// writes, makes that file the only one. Its folder must be there.
void keep_single_file(Destination& destination, std::span<const std::string> names);

// For the beginning of a command, before it works for long: throws InputError if the folder cannot be made or written
// to, if one of `names` in it is something that cannot be replaced, or is one of `inputs`, or if the report that is
// there says that the files are those of another input. Files without such a report are replaced. Leaves nothing
// behind.
void check_outputs(const Destination& destination, std::span<const std::string> names,
                   std::span<const std::filesystem::path> inputs);

// The same for a single file.
void check_output(const std::filesystem::path& file, std::span<const std::filesystem::path> inputs);

// Files that appear in their folder all together, and only if everything went well: they are written to a folder of
// their own, `.orchard-XXXXXX` inside the other, and moved at the end. An error or a signal before that leaves nothing
// behind, and whatever an earlier run wrote as it was. Each one carries the provenance when it appears.
class Outputs {
 public:
  // Throws Error if the folder cannot be made.
  explicit Outputs(Destination destination);
  ~Outputs();
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  // Returns where to write a file until commit(). `what` describes it in the list for the user; a file without a
  // description is not listed. Throws Cancelled after a signal.
  std::filesystem::path add(const std::string& name, const std::string& what = {});

  // The same without a description, for files that may fail to be written.
  std::filesystem::path staged(const std::string& name) const { return staging_ / name; }

  // Returns the bytes of a file that was added or staged, and empty if there is no such file. Unless `keep` is set, the
  // file is then no longer an output.
  std::string take(const std::string& name, bool keep);

  // Where commit() puts it.
  std::filesystem::path place_of(const std::string& name) const;

  // Writes the report, with the provenance in it.
  void add_report(nlohmann::json& report, const std::string& what = {});

  // Moves everything, each file in place of an older one of its name. Throws Error, and InputError if meanwhile a run
  // on another input has put its files there.
  void commit();

  // A line for each file that has something to tell, and one if those of a run with other options were replaced.
  void print() const;

 private:
  void commit_single();

  Destination destination_;
  std::filesystem::path staging_;
  std::optional<RecordedRun> replaced_;
  std::vector<std::filesystem::path> made_;  // folders that did not exist, the outermost first
  std::vector<std::pair<std::string, std::string>> files_;
  Writing writing_;
};

}  // namespace orchard::apps
