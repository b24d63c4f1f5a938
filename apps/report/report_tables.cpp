#include "report/report_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "orchard/geometry/xml_escaped.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr std::size_t kShortList = 6;   // numbers that fit a cell
constexpr std::size_t kMaxColumns = 8;  // of a list of objects that is shown with its items side by side
constexpr std::size_t kMaxItems = 200;  // of longer lists
constexpr double kLongestBar = 20;      // letters

// Parts of interest only if something is wrong; they are closed at first.
constexpr std::array kAside{"reading", "repair", "union", "wrap", "gap_repair"};

bool is_list_of_objects(const json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const json& item) { return item.is_object(); });
}

bool is_list_of_words(const json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const json& item) { return item.is_string(); });
}

bool fits_a_cell(const json& value) {
  if (!value.is_structured()) return true;
  return value.is_array() && value.size() <= kShortList &&
         std::none_of(value.begin(), value.end(), [](const json& item) { return item.is_structured(); });
}

// The keys of an object: those of the schema in its order, then the others.
std::vector<std::string> keys_in_order(const json& object, const Schema& schema) {
  std::vector<std::string> keys;
  for (const std::string& key : keys_of(schema))
    if (object.contains(key) && std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  for (const auto& [key, unused] : object.items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  return keys;
}

// A key whose object has times by stage.
bool holds_times(const std::string& key) { return key == "seconds" || key.ends_with("_seconds"); }

void add_rows(const json& object, const Schema& schema, const std::string& before, std::vector<ReportRow>& rows) {
  const KeyWords own = words_of(schema);
  for (const std::string& key : keys_in_order(object, schema)) {
    const json& value = object[key];
    const Schema& inside = schema_of(schema, key);
    const std::string name = before + key_in_words(key);
    if (value.is_object()) {
      if (!holds_times(key)) add_rows(value, inside, name + ": ", rows);
    } else if (fits_a_cell(value) && !is_list_of_words(value)) {
      KeyWords words = words_of(inside);
      if (words.meaning.empty() && words.unit.empty()) words.unit = own.unit;
      rows.push_back({name, value, words});
    }
  }
}

std::string head(const std::vector<std::string>& titles) {
  std::string text = "<tr>";
  for (const std::string& title : titles) text += "<th>" + xml_escaped(title) + "</th>";
  return text + "</tr>\n";
}

std::string in_table(const std::string& rows) { return "<div class=\"wide\"><table>\n" + rows + "</table></div>\n"; }

std::string values_table(const std::vector<ReportRow>& rows) {
  std::vector<ComparedRow> compared;
  compared.reserve(rows.size());
  for (const ReportRow& row : rows) compared.push_back({row.name, {row.value}, row.words});
  return table_of({"value"}, compared);
}

std::string times_table(const json& seconds) {
  double longest = 0;
  for (const auto& [stage, time] : seconds.items())
    if (time.is_number()) longest = std::max(longest, time.get<double>());
  std::string rows;
  for (const auto& [stage, time] : seconds.items()) {
    if (!time.is_number()) continue;
    const double length = longest > 0 ? kLongestBar * time.get<double>() / longest : 0;
    rows += fmt::format(
        "<tr><td>{}</td><td>{:.2f} s</td><td class=\"bars\"><span class=\"bar\" style=\"width:{:.1f}em\"></span></td>"
        "</tr>\n",
        xml_escaped(key_in_words(stage)), time.get<double>(), length);
  }
  return in_table(rows);
}

std::string list_of(const json& lines) {
  std::string text;
  for (const json& line : lines) text += "<li>" + xml_escaped(line.get<std::string>()) + "</li>\n";
  return "<ul>\n" + text + "</ul>\n";
}

// What an item of a list is called: by its file, link, level or name, or else by its number.
std::string label_of(const json& item, std::size_t number) {
  for (const char* key : {"file", "link", "level", "name", "axis", "algorithm"})
    if (item.contains(key) && item[key].is_string()) return item[key].get<std::string>();
  return std::to_string(number);
}

// Few items side by side, with an explanation for each row.
std::string items_side_by_side(const json& list, const Schema& schema) {
  std::vector<std::string> columns;
  std::vector<ComparedRow> rows;
  for (std::size_t i = 0; i < list.size(); ++i) {
    columns.push_back(label_of(list[i], i));
    for (const ReportRow& row : rows_of(list[i], schema_of_items(schema))) {
      auto at = std::find_if(rows.begin(), rows.end(), [&](const ComparedRow& one) { return one.name == row.name; });
      if (at == rows.end()) at = rows.insert(rows.end(), ComparedRow{row.name, {}, row.words});
      at->values.resize(i);
      at->values.push_back(row.value);
    }
  }
  for (ComparedRow& row : rows) row.values.resize(list.size());
  return table_of(columns, rows);
}

// Many items below each other; what the columns mean follows.
std::string items_below(const json& list, const Schema& schema) {
  const Schema& of_item = schema_of_items(schema);
  std::vector<ComparedRow> columns;
  const std::size_t shown = std::min(list.size(), kMaxItems);
  for (std::size_t i = 0; i < shown; ++i)
    for (const ReportRow& row : rows_of(list[i], of_item)) {
      const auto same = [&](const ComparedRow& one) { return one.name == row.name; };
      auto at = std::find_if(columns.begin(), columns.end(), same);
      if (at == columns.end()) at = columns.insert(columns.end(), ComparedRow{row.name, {}, row.words});
      at->values.resize(i);
      at->values.push_back(row.value);
    }
  std::vector<std::string> titles{""};
  std::string meanings;
  for (ComparedRow& column : columns) {
    column.values.resize(shown);
    titles.push_back(column.name);
    if (column.words.meaning.empty()) continue;
    meanings += fmt::format("<dt>{}</dt><dd>{}{}</dd>\n", xml_escaped(column.name), xml_escaped(column.words.meaning),
                            column.words.unit.empty() ? "" : " In " + xml_escaped(column.words.unit) + ".");
  }
  std::string rows = head(titles);
  for (std::size_t i = 0; i < shown; ++i) {
    rows += fmt::format("<tr><td>{}</td>", i + 1);
    for (const ComparedRow& column : columns) rows += "<td>" + value_in_html(column.values[i]) + "</td>";
    rows += "</tr>\n";
  }
  std::string text = in_table(rows);
  if (shown < list.size())
    text += fmt::format("<p class=\"note\">The first {} of {}; the JSON has all.</p>\n", shown, list.size());
  if (meanings.empty()) return text;
  return text + "<details><summary>What the columns mean</summary><dl>\n" + meanings + "</dl></details>\n";
}

std::string heading(const std::string& key, const Schema& schema) {
  const std::string meaning = words_of(schema).meaning;
  std::string text = "<h3>" + xml_escaped(key_in_words(key)) + "</h3>\n";
  if (!meaning.empty()) text += "<p class=\"note\">" + xml_escaped(meaning) + "</p>\n";
  return text;
}

// What an object holds beyond the rows of one table: lists and times, also those of objects within it.
std::string lists_within(const json& object, const Schema& schema) {
  std::string text;
  for (const std::string& key : keys_in_order(object, schema)) {
    const json& value = object[key];
    const Schema& inside = schema_of(schema, key);
    if (value.is_object() && holds_times(key)) {
      text += heading(key, inside) + times_table(value);
    } else if (value.is_object()) {
      text += lists_within(value, inside);
    } else if (is_list_of_objects(value)) {
      text += heading(key, inside);
      const bool few = value.size() <= kMaxColumns;
      text += few ? items_side_by_side(value, inside) : items_below(value, inside);
      for (std::size_t i = 0; few && i < value.size(); ++i)
        if (const std::string more = lists_within(value[i], schema_of_items(inside)); !more.empty())
          text += "<h4>" + xml_escaped(label_of(value[i], i)) + "</h4>\n" + more;
    } else if (is_list_of_words(value)) {
      text += heading(key, inside) + list_of(value);
    }
  }
  return text;
}

std::string part(const std::string& key, const json& value, const Schema& schema) {
  std::string text;
  if (const std::vector<ReportRow> rows = rows_of(value, schema); !rows.empty()) text += values_table(rows);
  text += lists_within(value, schema);
  if (text.empty()) return {};
  if (std::find(kAside.begin(), kAside.end(), key) == kAside.end()) return heading(key, schema) + text;
  const std::string meaning = words_of(schema).meaning;
  return fmt::format("<details><summary>{}{}</summary>{}</details>\n", xml_escaped(key_in_words(key)),
                     meaning.empty() ? "" : ": " + xml_escaped(meaning), text);
}

}  // namespace

std::vector<ReportRow> rows_of(const json& object, const Schema& schema) {
  std::vector<ReportRow> rows;
  if (object.is_object()) add_rows(object, schema, "", rows);
  return rows;
}

std::string value_in_html(const json& value) {
  if (value.is_null()) return "-";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string()) return xml_escaped(value.get<std::string>());
  if (value.is_number_float()) return fmt::format("{:.5g}", value.get<double>());
  if (!value.is_array()) return xml_escaped(value.dump());
  std::string text;
  for (const json& item : value) text += (text.empty() ? "" : ", ") + value_in_html(item);
  return text.empty() ? "-" : text;
}

std::string table_of(const std::vector<std::string>& columns, const std::vector<ComparedRow>& rows) {
  std::vector<std::string> titles{""};
  titles.insert(titles.end(), columns.begin(), columns.end());
  titles.insert(titles.end(), {"unit", "what it is"});
  std::string text = head(titles);
  for (const ComparedRow& row : rows) {
    text += "<tr><td>" + xml_escaped(row.name) + "</td>";
    for (const json& value : row.values) text += "<td>" + value_in_html(value) + "</td>";
    text += fmt::format("<td class=\"unit\">{}</td><td class=\"word\">{}</td></tr>\n", xml_escaped(row.words.unit),
                        xml_escaped(row.words.meaning));
  }
  return in_table(text);
}

std::string sections_of(const json& report, const Schema& schema) {
  json own = json::object();  // what is in no part
  std::string parts;
  for (const std::string& key : keys_in_order(report, schema)) {
    if (key == "provenance") continue;
    const json& value = report[key];
    if (value.is_object() && !holds_times(key)) {
      parts += part(key, value, schema_of(schema, key));
    } else {
      own[key] = value;
    }
  }
  std::string text;
  if (const std::vector<ReportRow> rows = rows_of(own, schema); !rows.empty()) text += values_table(rows);
  return text + lists_within(own, schema) + parts;
}

}  // namespace orchard::apps
