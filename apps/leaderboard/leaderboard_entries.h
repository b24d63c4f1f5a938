#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"

// Finds the meshes of a folder, and the medial axes that several systems have made of them.
namespace orchard::apps {

// The axis of one system for one mesh.
struct LeaderboardEntry {
  std::filesystem::path mesh, file;  // `file` is empty for an axis that is still to be built
  std::string model, system;
  std::optional<Index> asked;  // the number of balls in the file's name
  std::string note;            // how the name was read, if that is not obvious; otherwise empty
};

struct LeaderboardFolder {
  std::vector<LeaderboardEntry> entries;  // sorted by model, number of balls asked for, system and file
  std::vector<std::string> skipped;       // a sentence for each file that is no entry
};

// Returns the axes in a folder. Meshes are the files of the folder with the name of a mesh (input/mesh_input.h). Axes
// are files MODEL-SYSTEM-N.ext next to the meshes or in the folder `results`; MODEL is the longest name of a mesh that
// the file name begins with, SYSTEM may contain dashes, and N, the number of balls, may be missing. A table
// `results.csv` next to the axes replaces these rules for the files that it lists; its columns are file, mesh, system
// and, optionally, n. Throws InputError if the folder does not exist or the table cannot be read.
LeaderboardFolder find_entries(const std::filesystem::path& folder);

}  // namespace orchard::apps
