#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "input/load_solid.h"
#include "leaderboard/leaderboard_entries.h"
#include "orchard/geometry/progress.h"

// The measures of axes, kept in a folder so that a run that was stopped goes on where it was.
namespace orchard::apps {

struct LeaderboardOptions {
  Index quality_samples = 20'000;
  std::vector<Index> vertices;        // numbers of balls that are built beside those of the entries
  std::vector<std::string> builders;  // of orchard: "refined" and "raw" axes in few balls
  bool connect = false;               // balls without cells
  Index samples = 5000;               // surface points of orchard's axes
  std::uint64_t seed = 1;
};

// One axis, measured.
struct LeaderboardRow {
  std::string model, system, file;  // file: without its folder
  Index asked = 0;                  // the number of balls in the name, or that it has
  Index balls = 0, edges = 0, triangles = 0;
  bool own = false;                                    // built by orchard
  std::string refused = {};                            // why it could not be measured; then nothing below counts
  std::vector<std::string> notes = {};                 // what limits its comparison
  nlohmann::json measures = nlohmann::json::object();  // by the names of medial_measures()

  // Where it is worst: measure (protrusion, coverage or dent), value (% of the diagonal) and position of each place.
  nlohmann::json worst = nlohmann::json::array();

  double value(const char* measure) const;  // NaN where it is not defined
  bool topology_right() const { return value("topology_right") == 1; }
  // Whether it is a medial mesh as other systems write it, so that its errors are those of the same thing.
  bool comparable() const { return refused.empty() && (edges > 0 || balls == 1); }
};
nlohmann::json to_json(const LeaderboardRow& row);

// The files that show a measured row, below the folder of the leaderboard.
struct WorstFiles {
  std::filesystem::path mesh = {}, axis = {}, places = {};  // .vtp
  std::filesystem::path ball = {};                          // JSON: x, y, z and radius of the mesh's bounding ball
};
WorstFiles worst_files(const LeaderboardRow& row);
LeaderboardRow row_from(const nlohmann::json& json);

// Measures every entry, and builds and measures orchard's axes for every mesh that has one, at the same numbers of
// balls. `folder` keeps each row (rows/), what ParaView shows of it (worst/, if the program was built with VTK) and
// each axis that was built (axes/): what is there with the same inputs, options and version is not made again. Rows
// come by model, number of balls asked for, system and file. A mesh or file that cannot be read makes rows that say so.
std::vector<LeaderboardRow> measure_entries(const LeaderboardFolder& found, const LeaderboardOptions& options,
                                            const std::filesystem::path& folder, const Progress& progress);

}  // namespace orchard::apps
