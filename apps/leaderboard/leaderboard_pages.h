#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "leaderboard/leaderboard_rows.h"

// The rows of a leaderboard, for people and for programs.
namespace orchard::apps {

// Of all pairs of an axis of another system and orchard's best one at the same number of balls, or fewer.
struct LeaderboardScore {
  std::size_t pairs = 0, lower_max = 0, lower_mean = 0, right = 0;  // right: those of orchard with the solid's topology
  std::vector<std::string> behind;  // a sentence for each pair that is not lower in both
};
LeaderboardScore score(const std::vector<LeaderboardRow>& rows);

// Markdown: what was compared, the score, a table with the best of each model and number of balls in bold, what is not
// comparable, and what was skipped. `plots`: the names of the pictures, by model.
std::string to_markdown(const std::vector<LeaderboardRow>& rows, const std::vector<std::string>& skipped,
                        const std::vector<std::pair<std::string, std::string>>& plots);
// A row for each axis, a column for each measure; not defined: empty.
std::string to_csv(const std::vector<LeaderboardRow>& rows);
// As docs/reference/leaderboard.schema.json says.
nlohmann::json to_json(const std::vector<LeaderboardRow>& rows, const std::vector<std::string>& skipped);
// Largest and mean distance against the number of balls, a line for each system.
std::string to_svg(const std::vector<LeaderboardRow>& rows, const std::string& model);

}  // namespace orchard::apps
