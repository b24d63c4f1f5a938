#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/report_schema.h"

// The tables of a report's page: each value with its unit and a word of explanation, from the schema.
namespace orchard::apps {

// One value of a report.
struct ReportRow {
  std::string name;  // "thickness: min" for a key within another one
  nlohmann::json value;
  KeyWords words;
};

// The values of an object in the order of the schema: numbers, words and short lists; those of objects within it, too.
// Lists of objects are left out.
std::vector<ReportRow> rows_of(const nlohmann::json& object, const Schema& schema);

// A value for people: five digits, "yes" and "no", "-" for null; as HTML.
std::string value_in_html(const nlohmann::json& value);

// A table of several columns of values, each row with its unit and explanation. `columns` has the head of each.
struct ComparedRow {
  std::string name;
  std::vector<nlohmann::json> values;  // one for each column
  KeyWords words;
};
std::string table_of(const std::vector<std::string>& columns, const std::vector<ComparedRow>& rows);

// Everything that a report holds, part by part, but for its provenance. Long lists are cut, and say so.
std::string sections_of(const nlohmann::json& report, const Schema& schema);

}  // namespace orchard::apps
