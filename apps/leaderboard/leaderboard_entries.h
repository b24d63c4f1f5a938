#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"

// What a folder of meshes and of axes of several systems holds.
namespace orchard::apps {

// The axis of one system for one mesh.
struct LeaderboardEntry {
  std::filesystem::path mesh, file;  // file: empty for an axis that is still to be built
  std::string model, system;
  std::optional<Index> asked;  // the number of balls in the file's name
  std::string note;            // of how the name was read; empty: as it stands
};

struct LeaderboardFolder {
  std::vector<LeaderboardEntry> entries;  // by model, number of balls asked for, system and file
  std::vector<std::string> skipped;       // a sentence for each file that is no entry
};

// Meshes are the files of the folder whose names end so (input/mesh_input.h); axes are files MODEL-SYSTEM-N.ext beside
// them or in its folder `results`, where MODEL is the longest name of a mesh that fits, SYSTEM may have dashes and N
// may be missing. A table `results.csv` beside them, with the columns file, mesh and system, and n if you like, says
// otherwise for the files that it lists. Throws InputError if there is no such folder or the table cannot be read.
LeaderboardFolder find_entries(const std::filesystem::path& folder);

}  // namespace orchard::apps
