#pragma once
#include <string>

// The schemas of reports, which CMake copies into the program from docs/reference.
namespace orchard::apps {

std::string reports_schema_text();      // reports.schema.json
std::string leaderboard_schema_text();  // leaderboard.schema.json

}  // namespace orchard::apps
