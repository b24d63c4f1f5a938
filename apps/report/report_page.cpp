#include "report/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/base64.h"
#include "orchard/geometry/xml_escaped.h"
#include "report/key_figures.h"
#include "report/report_plots.h"
#include "report/report_schema.h"
#include "report/report_tables.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr const char* kStyle = R"(
* { box-sizing: border-box; }
body { font: 15px/1.5 system-ui, sans-serif; color: #21293a; max-width: 1500px; margin: 1.5em auto; padding: 0 1.5em; }
h1 { margin-bottom: 0; overflow-wrap: anywhere; } h2 { margin-top: 2.2em; border-bottom: 2px solid #d6dbe2; }
h3 { margin: 1.6em 0 .3em; }
code, pre { font: 13px/1.4 ui-monospace, monospace; background: #f3f5f8; padding: .1em .3em; border-radius: 3px;
  overflow-wrap: anywhere; }
pre { padding: .8em; overflow: auto; max-height: 40em; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; }
th, td { text-align: right; padding: .2em .8em; border-bottom: 1px solid #e6e9ee; vertical-align: top;
  font-variant-numeric: tabular-nums; }
th { font-weight: 600; color: #5a6678; }
th:first-child, td:first-child, th:nth-last-child(-n+2), .unit, .word, .bars { text-align: left; }
table.plain th, table.plain td { text-align: left; }
.unit { color: #5a6678; white-space: nowrap; } .word { color: #5a6678; min-width: 16em; }
.figures { display: flex; flex-wrap: wrap; gap: .8em; padding: 0; margin: 1em 0; list-style: none; }
.figures li { flex: 1 1 9em; background: #f3f5f8; border-radius: 6px; padding: .5em .9em; }
.figures b { display: block; font-size: 1.35em; font-weight: 600; }
.figures span { color: #5a6678; }
.kept, .doubts, .broken { border-left: 4px solid; padding: .6em 1em; margin-top: .6em; overflow-wrap: anywhere; }
.kept { background: #e8f4ea; border-color: #2e8b4f; } .doubts { background: #fdf1dc; border-color: #d98a1e; }
.broken { background: #fbe5e1; border-color: #b3261e; }
.plots { display: flex; flex-wrap: wrap; gap: 1em; } .plots > * { flex: 1 1 340px; max-width: 720px; min-width: 0; }
.bar { display: inline-block; height: .8em; background: #4e79a7; border-radius: 2px; }
img { max-width: 100%; height: auto; } svg { width: 100%; height: auto; }
dt { font-weight: 600; } .note { color: #5a6678; margin: .2em 0; } summary { cursor: pointer; margin: .5em 0; }
)";

// The run of a page, with what is known of its kind.
struct ShownRun {
  const ReportPage* page;
  ReportKind kind;
  std::string title;
};

std::string command_line_of(const json& report) {
  const std::string typed = report.value("/provenance/run/typed"_json_pointer, std::string());
  return typed.empty() ? report.value("/provenance/command_line"_json_pointer, std::string()) : typed;
}

std::string input_of(const json& report) {
  const json inputs = report.value("/provenance/inputs"_json_pointer, json::array());
  if (inputs.empty()) return report.value("scene", std::string("run"));
  return std::filesystem::path(inputs.front().value("file", "")).stem().string();
}

ShownRun run_of(const ReportPage& page) {
  const ReportKind kind = kind_of(page.report);
  return {&page, kind, input_of(page.report) + ": " + key_in_words(kind.name.empty() ? "report" : kind.name)};
}

std::string box(const char* look, const std::string& text) {
  return text.empty() ? std::string() : fmt::format("<div class=\"{}\">{}</div>\n", look, xml_escaped(text));
}

// What the report says of its promise.
std::string promise_of(const json& report) {
  const auto promise = report.find("promise");
  if (promise == report.end() || !promise->contains("kept")) return {};
  if ((*promise)["kept"].get<bool>()) {
    const std::string text = promise->value("text", std::string());
    return box("kept", "The result keeps what it promises" + (text.empty() ? "." : ": " + text + "."));
  }
  std::string text = "The result does not keep what it promises";
  for (const json& line : promise->value("broken", json::array()))
    text += (text.ends_with("promises") ? ": " : "; ") + line.get<std::string>();
  return box("broken", text + ".");
}

std::string figures_list(const ShownRun& run) {
  std::string items;
  for (const KeyFigure& figure : key_figures(run.kind.name, run.page->report))
    items += fmt::format("<li><b>{}</b><span>{}</span></li>\n", value_in_html(figure.value), xml_escaped(figure.title));
  return items.empty() ? items : "<ul class=\"figures\">\n" + items + "</ul>\n";
}

std::string plots_of(const ShownRun& run) {
  std::string text;
  for (const plot::Plot& plot : report_plots(run.kind.name, run.page->report))
    text += "<div>" + plot::to_svg({plot}) + "</div>\n";
  return text.empty() ? text : "<div class=\"plots\">\n" + text + "</div>\n";
}

std::string pictures_of(const ShownRun& run) {
  std::string text;
  for (const std::string& bytes : run.page->pictures)
    text += "<p><img alt=\"" + xml_escaped(run.title) + "\" src=\"data:image/png;base64," + base64(bytes) + "\"></p>\n";
  return text;
}

std::string origin_of(const json& report) {
  const json provenance = report.value("provenance", json::object());
  std::string rows;
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) rows += "<tr><td>" + name + "</td><td>" + xml_escaped(value) + "</td></tr>\n";
  };
  add("version of orchard", provenance.value("version", ""));
  for (const json& input : provenance.value("inputs", json::array()))
    add("input", input.value("file", "") + ", checksum " + input.value("checksum", ""));
  const json options = provenance.value("options", json::object());
  for (const auto& [name, value] : options.items())
    add("--" + xml_escaped(name), value.is_string() ? value.get<std::string>() : value.dump());
  if (provenance.contains("seed")) add("seed", provenance["seed"].dump());
  return "<details><summary>Where it comes from</summary><div class=\"wide\"><table class=\"plain\">\n" + rows +
         "</table></div></details>\n";
}

// Everything of one run but its heading.
std::string body_of(const ShownRun& run) {
  const json& report = run.page->report;
  std::string text = "<p><code>" + xml_escaped(command_line_of(report)) + "</code></p>\n";
  text += promise_of(report);
  text += box("kept", run.page->certificate);
  text += box("doubts", run.page->doubts);
  text += box("doubts", report.value("warning", std::string()));
  text += figures_list(run) + pictures_of(run) + plots_of(run);
  text += sections_of(report, *run.kind.schema) + origin_of(report);
  return text + "<details><summary>The whole report as JSON</summary><pre>" + xml_escaped(report.dump(1)) +
         "</pre></details>\n";
}

std::string overview(const std::vector<ShownRun>& runs) {
  std::string rows = "<tr><th>run</th><th>command</th></tr>\n";
  for (std::size_t i = 0; i < runs.size(); ++i)
    rows += fmt::format("<tr><td><a href=\"#run-{0}\">{0}. {1}</a></td><td><code>{2}</code></td></tr>\n", i + 1,
                        xml_escaped(runs[i].title), xml_escaped(command_line_of(runs[i].page->report)));
  return "<div class=\"wide\"><table class=\"plain\">\n" + rows + "</table></div>\n";
}

// Of runs of one kind: the values that are not the same in all of them.
std::string comparison(const std::vector<std::size_t>& numbers, const std::vector<ShownRun>& runs) {
  std::vector<ComparedRow> rows;
  std::vector<std::string> columns;
  for (std::size_t column = 0; column < numbers.size(); ++column) {
    const ShownRun& run = runs[numbers[column]];
    columns.push_back(fmt::format("{}. {}", numbers[column] + 1, input_of(run.page->report)));
    json report = run.page->report;
    report.erase("provenance");
    for (const ReportRow& row : rows_of(report, *run.kind.schema)) {
      auto at = std::find_if(rows.begin(), rows.end(), [&](const ComparedRow& one) { return one.name == row.name; });
      if (at == rows.end()) at = rows.insert(rows.end(), ComparedRow{row.name, {}, row.words});
      at->values.resize(column);
      at->values.push_back(row.value);
    }
  }
  for (ComparedRow& row : rows) row.values.resize(numbers.size());
  std::erase_if(rows, [](const ComparedRow& row) {
    return std::all_of(row.values.begin(), row.values.end(), [&](const json& v) { return v == row.values.front(); });
  });
  if (rows.empty()) return "<p>All of their values are the same.</p>\n";
  return table_of(columns, rows);
}

std::string comparisons(const std::vector<ShownRun>& runs) {
  std::map<std::string, std::vector<std::size_t>> kinds;
  for (std::size_t i = 0; i < runs.size(); ++i) kinds[runs[i].kind.name].push_back(i);
  std::string text;
  for (const auto& [kind, numbers] : kinds) {
    if (numbers.size() < 2 || kind.empty()) continue;
    text += fmt::format("<h2>Runs of {} beside each other</h2>\n<p class=\"note\">The values that differ.</p>\n",
                        xml_escaped(key_in_words(kind)));
    text += comparison(numbers, runs);
  }
  return text;
}

}  // namespace

ReportPage page_of(const json& report, const std::string& picture) {
  ReportPage page{.report = report};
  if (!picture.empty()) page.pictures.push_back(picture);
  return page;
}

std::string to_html(const std::vector<ReportPage>& pages) {
  std::vector<ShownRun> runs;
  runs.reserve(pages.size());
  for (const ReportPage& page : pages) runs.push_back(run_of(page));
  const std::string title = runs.size() == 1 ? runs.front().title : fmt::format("{} runs of orchard", runs.size());
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>" +
      xml_escaped(title) + "</title>\n<style>" + kStyle + "</style></head><body>\n<h1>" + xml_escaped(title) +
      "</h1>\n";
  if (runs.size() == 1) {
    text += body_of(runs.front());
  } else {
    text += overview(runs) + comparisons(runs);
    for (std::size_t i = 0; i < runs.size(); ++i)
      text += fmt::format("<section id=\"run-{0}\"><h2>{0}. {1}</h2>\n{2}</section>\n", i + 1,
                          xml_escaped(runs[i].title), body_of(runs[i]));
  }
  return text + "</body></html>\n";
}

std::string page_name(const std::filesystem::path& model, const std::string& command) {
  return named(model, "-" + command + "-report.html");
}

void write_report_page(const std::string& name, const ReportPage& page, Outputs& outputs) {
  write_file(outputs.add(name, "this report as a page, with everything in it"), to_html({page}));
}

}  // namespace orchard::apps
