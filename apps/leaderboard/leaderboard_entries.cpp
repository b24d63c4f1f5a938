#include "leaderboard/leaderboard_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <tuple>

#include "command_line/number_text.h"
#include "input/input_file.h"
#include "input/mesh_input.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/text_lines.h"
#include "orchard/medial/read_axis.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

bool one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}
bool may_be_mesh(const fs::path& file) { return is_mesh_name(file); }
bool may_be_axis(const fs::path& file) {
  const std::span<const char* const> known = axis_extensions();
  return std::find(known.begin(), known.end(), lower_extension(file)) != known.end();
}

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Returns the name without the endings that programs add to the files of one axis.
std::string stem_of(const fs::path& file) {
  std::string stem = file.stem().string();
  for (const std::string ending : {"_center", "_skel_face", "_skel_edge", "_sphere"}) {
    if (stem.ends_with(ending)) return stem.substr(0, stem.size() - ending.size());
  }
  return stem;
}

// "SYSTEM-N" or "SYSTEM".
void read_system(const std::string& text, LeaderboardEntry& entry) {
  const std::size_t dash = text.rfind('-');
  entry.system = text;
  if (dash == std::string::npos || dash == 0) return;
  entry.asked = whole_number(text.substr(dash + 1));
  if (entry.asked) entry.system = text.substr(0, dash);
}

class Finder {
 public:
  explicit Finder(const fs::path& folder) : folder_(folder) {}

  LeaderboardFolder run() {
    if (!fs::is_directory(folder_)) throw InputError(folder_.string() + ": this is no folder");
    const std::vector<fs::path> beside = files_of(folder_);
    find_meshes(beside);
    if (meshes_.empty())
      throw InputError(folder_.string() + ": the folder contains no mesh " + input_formats_in_words());
    for (const fs::path& table : {folder_ / "results.csv", folder_ / "results" / "results.csv"}) {
      if (fs::is_regular_file(table)) read_table(table);
    }
    for (const fs::path& file : beside) {
      if (is_result_beside(file)) add(file);
    }
    if (fs::is_directory(folder_ / "results")) {
      for (const fs::path& file : files_of(folder_ / "results")) {
        if (may_be_axis(file)) add(file);
      }
    }
    std::sort(result_.entries.begin(), result_.entries.end(), [](const auto& a, const auto& b) {
      return std::tie(a.model, a.asked, a.system, a.file) < std::tie(b.model, b.asked, b.system, b.file);
    });
    return std::move(result_);
  }

 private:
  // A file "a-b-10.obj" beside a mesh "a" is a result.
  void find_meshes(const std::vector<fs::path>& files) {
    for (const fs::path& file : files) {
      if (may_be_mesh(file)) meshes_.emplace(file.stem().string(), file);
    }
    for (auto at = meshes_.begin(); at != meshes_.end();) {
      const std::string model = longest_model(at->first, true);
      const bool result = !model.empty() && model != at->first && has_system_and_number(at->first, model);
      at = result ? meshes_.erase(at) : std::next(at);
    }
  }
  static bool has_system_and_number(const std::string& stem, const std::string& model) {
    LeaderboardEntry entry;
    read_system(stem.substr(model.size() + 1), entry);
    return entry.asked.has_value();
  }
  // The longest name of a mesh that `stem` begins with, before a dash or anything.
  std::string longest_model(const std::string& stem, bool dash) const {
    std::string longest;
    for (const auto& [model, file] : meshes_) {
      const bool fits = stem.starts_with(model) && (!dash || (stem.size() > model.size() && stem[model.size()] == '-'));
      if (fits && model.size() > longest.size() && model != stem) longest = model;
    }
    return longest;
  }
  bool is_result_beside(const fs::path& file) const {
    if (!may_be_axis(file) || table_.contains(file.filename().string()))
      return table_.contains(file.filename().string());
    const std::string stem = stem_of(file), model = longest_model(stem, true);
    const bool is_mesh = meshes_.contains(file.stem().string()) && may_be_mesh(file);
    return !is_mesh && !model.empty() && (!may_be_mesh(file) || has_system_and_number(stem, model));
  }

  void read_table(const fs::path& file) {
    std::string text;
    TextLines lines(file);
    std::vector<std::string> head;
    while (lines.next()) {
      std::vector<std::string> cells = cells_of(lines);
      if (head.empty()) {
        head = std::move(cells);
        for (const char* column : {"file", "mesh", "system"}) {
          if (std::find(head.begin(), head.end(), column) == head.end())
            lines.fail(std::string("the table has no column \"") + column + '"');
        }
        continue;
      }
      if (cells.size() != head.size()) lines.fail("expected " + std::to_string(head.size()) + " cells");
      std::map<std::string, std::string> row;
      for (std::size_t i = 0; i < head.size(); ++i) row[head[i]] = cells[i];
      const std::string model = fs::path(row["mesh"]).stem().string();
      if (!meshes_.contains(model)) lines.fail("there is no mesh of this name: " + row["mesh"]);
      if (!row["n"].empty() && !whole_number(row["n"])) lines.fail("expected a whole number for n");
      row["mesh"] = model;
      table_[row["file"]] = row;
    }
  }
  static std::vector<std::string> cells_of(TextLines& lines) {
    std::string line;
    for (std::string_view word = lines.word(); !word.empty(); word = lines.word())
      line += (line.empty() ? "" : " ") + std::string(word);
    std::vector<std::string> cells{""};
    for (const char c : line) {
      if (c == ',') {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    return cells;
  }

  void add(const fs::path& file) {
    const std::string name = file.filename().string();
    LeaderboardEntry entry{.mesh = {}, .file = file, .model = {}, .system = {}, .asked = {}, .note = {}};
    if (const auto row = table_.find(name); row != table_.end()) {
      entry.model = row->second.at("mesh");
      entry.system = row->second.at("system");
      if (const auto n = row->second.find("n"); n != row->second.end()) entry.asked = whole_number(n->second);
    } else if (!read_name(file, entry)) {
      result_.skipped.push_back(name + ": no mesh of the folder has a name that it begins with");
      return;
    }
    entry.mesh = meshes_.at(entry.model);
    // The files of one axis count once: Point2Skeleton's points before its faces, and an .off file before its .obj
    // file.
    const std::string family = file.parent_path().string() + '/' + stem_of(file);
    const bool pair = one_of(lower_extension(file), {".obj", ".off"});
    if (pair && !families_.insert(family).second) {
      if (lower_extension(file) != ".off") return;
      for (LeaderboardEntry& other : result_.entries) {
        if (other.file.parent_path().string() + '/' + stem_of(other.file) == family) other.file = file;
      }
      return;
    }
    result_.entries.push_back(std::move(entry));
  }
  bool read_name(const fs::path& file, LeaderboardEntry& entry) const {
    const std::string stem = stem_of(file);
    entry.model = longest_model(stem, true);
    std::size_t start = entry.model.size();
    if (entry.model.empty()) {
      // "bears-system-10" of a mesh "bear".
      entry.model = longest_model(stem, false);
      start = stem.find('-', entry.model.size());
      if (entry.model.empty() || start == std::string::npos) return false;
      entry.note = "its name says " + stem.substr(0, start) + ", and " + entry.model + " fits best";
    }
    read_system(stem.substr(start + 1), entry);
    return !entry.system.empty();
  }

  const fs::path folder_;
  std::map<std::string, fs::path> meshes_;                           // by name
  std::map<std::string, std::map<std::string, std::string>> table_;  // of results.csv: rows by file
  std::set<std::string> families_;
  LeaderboardFolder result_;
};

}  // namespace

LeaderboardFolder find_entries(const std::filesystem::path& folder) { return Finder(folder).run(); }

}  // namespace orchard::apps
