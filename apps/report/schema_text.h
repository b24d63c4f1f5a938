#pragma once

// The schemas of reports, which CMake copies into the program from docs/reference.
namespace orchard::apps {

extern const char* const kReportsSchema;      // reports.schema.json
extern const char* const kLeaderboardSchema;  // leaderboard.schema.json

}  // namespace orchard::apps
