#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.h"

// A folder of generated meshes, and what a batch makes of it.
namespace orchard::test {

// What most tests do with every mesh: an octree of one level, in a few milliseconds.
inline const std::vector<std::string> kQuickTree{"--", "build", "--method", "octree", "--depth", "1", "--no-views"};

std::string content_of(const std::filesystem::path& file);

// How many meshes: 100, or 1,000 in the long tests.
std::size_t batch_meshes();

// Writes closed meshes of at most 300 triangles to `folder`, every twentieth broken, in turn: open, not a number,
// garbage, huge, endless. Returns the options that make the worker of an endless one hang.
std::vector<std::string> add_batch_meshes(const Workplace& here, const std::string& folder, std::size_t count);

// The status that the row of a mesh has, by its number.
const char* batch_status(std::size_t number);

// The JSON objects of a file, a line each; none if there is no such file.
std::vector<nlohmann::json> rows_in(const std::filesystem::path& file);

// The processes that have `text` in their command line, but for this one.
std::vector<pid_t> processes_with(const std::string& text);

// Waits until no process has it any more, half a minute at most; whether none has.
bool all_end(const std::string& text);

// How many results there are in a batch's folder.
std::size_t results_in(const std::filesystem::path& out);

}  // namespace orchard::test
