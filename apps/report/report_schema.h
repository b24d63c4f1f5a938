#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// What the keys of reports mean. The one source is docs/reference/reports.schema.json, and leaderboard.schema.json
// beside it.
namespace orchard::apps {

// Keeps the keys in the order of the file, which is the order for readers.
using Schema = nlohmann::ordered_json;

// Which definition of the schema a report follows.
struct ReportKind {
  std::string name;      // "medial", "medial_sweep"; empty for a report that no command of this version writes
  const Schema* schema;  // an empty object then
};
ReportKind kind_of(const nlohmann::json& report);

// The keys that a schema of an object mentions, in its order; those of the definitions that it includes follow.
std::vector<std::string> keys_of(const Schema& object);

// The schema of a key in an object, or of the items of a list, with references followed; an empty object if the schema
// does not mention it.
const Schema& schema_of(const Schema& object, const std::string& key);
const Schema& schema_of_items(const Schema& list);

// A description without its last sentence, "Unit: mesh units.", and the unit.
struct KeyWords {
  std::string meaning, unit;
};
KeyWords words_of(const Schema& schema);

// A key for people: "max radius" for "max_radius".
std::string key_in_words(const std::string& key);

}  // namespace orchard::apps
