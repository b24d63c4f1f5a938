#include <fmt/core.h>

#include <algorithm>
#include <fstream>

#include "command_line/commands.h"
#include "input/input_file.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "report/report_page.h"
#include "report/report_schema.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

json parsed(const fs::path& file) {
  check_input(file);
  std::ifstream in(file, std::ios::binary);
  try {
    return json::parse(in);
  } catch (const json::parse_error& error) {
    throw InputError(
        fmt::format("{}: the file is no JSON at byte {}; give a report that orchard wrote, or that --json printed",
                    file.string(), error.byte));
  }
}

// A report that a page can be made of: one is made to see whether values are missing.
json read_report(const fs::path& file) {
  json report = parsed(file);
  try {
    if (!report.is_object() || !report.contains("provenance") || kind_of(report).name.empty())
      throw InputError(file.string() +
                       ": this is no report of orchard, since its \"provenance\" names no command of this version");
    const int version = report.value("/provenance/schema_version"_json_pointer, 0);
    if (version != kSchemaVersion)
      throw InputError(
          fmt::format("{}: the report has version {} of the keys, and this program reads version {}; run "
                      "the command again",
                      file.string(), version, kSchemaVersion));
    to_html({{.report = report}});
  } catch (const json::exception&) {
    throw InputError(file.string() + ": the report lacks values that its command writes; run the command again");
  }
  return report;
}

// What the command drew beside its report, if it did.
std::vector<std::string> pictures_beside(const fs::path& file) {
  const fs::path picture = fs::path(file).replace_extension(".png");
  std::error_code ignored;
  if (!fs::is_regular_file(picture, ignored)) return {};
  return {content_of(picture)};
}

}  // namespace

void report(const ReportCommand& command) {
  if (lower_extension(command.page) != ".html")
    throw InputError(command.page.string() + ": a page needs a name that ends in .html");
  check_output(command.page, command.reports);
  std::vector<ReportPage> pages;
  for (const fs::path& file : command.reports)
    pages.push_back({.report = read_report(file), .pictures = pictures_beside(file)});
  const std::string text = to_html(pages);
  const Writing writing;
  write_file(command.page, text);
  if (!command.quiet)
    fmt::print("  {}  (a page of {} run{})\n", command.page.string(), pages.size(), pages.size() == 1 ? "" : "s");
}

}  // namespace orchard::apps
