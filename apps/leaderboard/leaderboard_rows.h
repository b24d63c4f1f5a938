#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "input/load_solid.h"
#include "leaderboard/leaderboard_entries.h"
#include "orchard/geometry/progress.h"

// Measures axes and keeps the results in a folder, so that a run that was stopped continues where it stopped.
namespace orchard::apps {

struct LeaderboardOptions {
  Index quality_samples = 20'000;
  std::vector<Index> vertices;        // numbers of balls of orchard's axes, in addition to those of the entries
  std::vector<std::string> builders;  // the kinds of orchard's axes: "refined", "raw"
  bool connect = false;               // connect balls without cells by their power diagram
  Index samples = 5000;               // surface points of orchard's axes
  std::uint64_t seed = 1;
};

// The measures of one axis.
struct LeaderboardRow {
  std::string model, system, file;  // `file` is without its folder
  Index asked = 0;                  // the number of balls in the file's name, or else that of the axis
  Index balls = 0, edges = 0, triangles = 0;
  bool own = false;                     // built by orchard
  std::string refused = {};             // why it could not be measured; in that case, the members below are not set
  std::vector<std::string> notes = {};  // what limits its comparison
  nlohmann::json measures = nlohmann::json::object();  // by the names of medial_measures()

  // The worst places: the measure (protrusion, coverage or dent), the value (% of the diagonal) and the position.
  nlohmann::json worst = nlohmann::json::array();

  double value(const char* measure) const;  // NaN where it is not defined
  bool topology_right() const { return value("topology_right") == 1; }
  // Whether it is a medial mesh, with edges or a single ball, so that its errors can be compared with those of others.
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
// each axis that was built (axes/). Results with the same inputs, options and version are reused. Rows are sorted by
// model, number of balls asked for, system and file. If a mesh or file cannot be read, its rows say so.
std::vector<LeaderboardRow> measure_entries(const LeaderboardFolder& found, const LeaderboardOptions& options,
                                            const std::filesystem::path& folder, const Progress& progress);

}  // namespace orchard::apps
