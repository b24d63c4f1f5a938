#include "report/report_schema.h"

#include <algorithm>

#include "report/schema_text.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

const Schema& nothing_known() {
  static const Schema empty = Schema::object();
  return empty;
}

const Schema& reports_schema() {
  static const Schema schema = Schema::parse(reports_schema_text());
  return schema;
}

const Schema& leaderboard_schema() {
  static const Schema schema = Schema::parse(leaderboard_schema_text());
  return schema;
}

const Schema& definition(const std::string& name) {
  const Schema& all = reports_schema()["$defs"];
  const auto at = all.find(name);
  return at == all.end() ? nothing_known() : *at;
}

// "#/$defs/level" stands for the definition of that name.
const Schema& followed(const Schema& schema) {
  const auto reference = schema.find("$ref");
  if (reference == schema.end()) return schema;
  const std::string target = reference->get<std::string>();
  return definition(target.substr(target.rfind('/') + 1));
}

// The word behind the program's name.
std::string command_of(const json& report) {
  const std::string line = report.value("/provenance/command_line"_json_pointer, std::string());
  const std::size_t begin = line.find(' ');
  if (begin == std::string::npos) return {};
  return line.substr(begin + 1, line.find(' ', begin + 1) - begin - 1);
}

std::string name_of_inspected(const json& report) {
  const std::string kind = report.value("kind", std::string());
  if (kind == "sphere-tree") return "inspect_tree";
  if (kind == "medial axis") return "inspect_axis";
  if (kind == "sphere set") return "inspect_spheres";
  return kind == "points" ? "inspect_points" : "inspect_mesh";
}

std::string name_of(const json& report) {
  std::string command = command_of(report);
  if (command == "medial") return report.contains("runs") ? "medial_sweep" : "medial";
  if (command == "build") return report.contains("levels") ? "build" : "build_cost";
  if (command == "inspect") return name_of_inspected(report);
  if (command == "audit") return report.contains("sets") && report.contains("link") ? "audit" : "audit_robot";
  if (command == "compare") return report.contains("axes") ? "compare_axes" : "compare";
  return command;
}

}  // namespace

ReportKind kind_of(const json& report) {
  const std::string name = name_of(report);
  const Schema& schema = name == "leaderboard" ? leaderboard_schema() : definition(name);
  return {schema.empty() ? "" : name, &schema};
}

std::vector<std::string> keys_of(const Schema& object) {
  std::vector<std::string> keys;
  if (const auto own = object.find("properties"); own != object.end())
    for (const auto& [key, schema] : own->items()) keys.push_back(key);
  if (const auto included = object.find("allOf"); included != object.end())
    for (const Schema& one : *included)
      for (const std::string& key : keys_of(followed(one))) keys.push_back(key);
  return keys;
}

const Schema& schema_of(const Schema& object, const std::string& key) {
  if (const auto own = object.find("properties"); own != object.end() && own->contains(key))
    return followed((*own)[key]);
  if (const auto included = object.find("allOf"); included != object.end())
    for (const Schema& one : *included)
      if (const Schema& found = schema_of(followed(one), key); !found.empty()) return found;
  return nothing_known();
}

const Schema& schema_of_items(const Schema& list) {
  const auto items = list.find("items");
  return items == list.end() || !items->is_object() ? nothing_known() : followed(*items);
}

KeyWords words_of(const Schema& schema) {
  std::string text = schema.value("description", std::string());
  const std::size_t at = text.rfind("Unit: ");
  if (at == std::string::npos) return {text, {}};
  std::string unit = text.substr(at + 6);
  if (unit.ends_with('.')) unit.pop_back();
  text.erase(at);
  text.erase(text.find_last_not_of(' ') + 1);
  return {text, unit};
}

std::string key_in_words(const std::string& key) {
  std::string words = key;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

}  // namespace orchard::apps
