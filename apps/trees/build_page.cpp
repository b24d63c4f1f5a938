#include "trees/build_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "command_line/text.h"
#include "orchard/geometry/base64.h"
#include "orchard/geometry/xml_escaped.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr const char* kStyle = R"(
body { font: 15px/1.5 system-ui, sans-serif; color: #21293a; max-width: 1000px; margin: 2em auto; padding: 0 1em; }
h1 { margin-bottom: 0; } h2 { margin-top: 2em; border-bottom: 1px solid #d6dbe2; }
code, pre { font: 13px/1.4 ui-monospace, monospace; background: #f3f5f8; padding: .1em .3em; border-radius: 3px; }
pre { padding: .8em; overflow-x: auto; }
table { border-collapse: collapse; } th, td { text-align: right; padding: .2em .8em; border-bottom: 1px solid #e6e9ee; }
th { font-weight: 600; color: #5a6678; } th:first-child, td:first-child { text-align: left; }
.certificate { background: #e8f4ea; border-left: 4px solid #2e8b4f; padding: .6em 1em; }
.doubts { background: #fdf1dc; border-left: 4px solid #d98a1e; padding: .6em 1em; margin-top: .6em; }
.bar { display: inline-block; height: .8em; background: #4e79a7; border-radius: 2px; }
img, svg { max-width: 100%; height: auto; } dt { font-weight: 600; } .note { color: #5a6678; }
)";

std::string number(const json& value) {
  if (value.is_null()) return "-";
  return value.is_number_float() ? fmt::format("{:.4g}", value.get<double>()) : value.dump();
}

using Cells = std::vector<std::string>;

std::string row(const Cells& cells, const char* tag) {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += fmt::format("<{0}>{1}</{0}>", tag, cell);
  return text + "</tr>\n";
}

// A table of what an object holds, each value as it stands; lists and objects are left out.
std::string values_table(const json& object) {
  std::string rows;
  for (const auto& [key, value] : object.items()) {
    if (value.is_structured()) continue;
    std::string name = key;
    std::replace(name.begin(), name.end(), '_', ' ');
    rows += row({xml_escaped(name), xml_escaped(value.is_string() ? value.get<std::string>() : number(value))}, "td");
  }
  return "<table>\n" + rows + "</table>\n";
}

std::string levels_table(const json& report) {
  std::string rows =
      row({"level", "spheres", "mean inaccuracy / R", "max / R", "volume outside / solid's", "mean over the octree's"},
          "th");
  for (std::size_t i = 0; i < report["levels"].size(); ++i) {
    const json& level = report["levels"][i];
    const auto at = [&](const char* key) { return level.contains(key) ? number(level[key]) : std::string("-"); };
    rows += row({std::to_string(i), at("spheres"), at("mean_inaccuracy_over_radius"), at("max_inaccuracy_over_radius"),
                 at("outside_volume_over_solid"), at("mean_inaccuracy_over_octree")},
                "td");
  }
  return "<table>\n" + rows + "</table>\n";
}

std::string timings(const json& seconds) {
  double longest = 0, total = 0;
  for (const auto& item : seconds.items()) {
    longest = std::max(longest, item.value().get<double>());
    total += item.value().get<double>();
  }
  std::string rows;
  for (const auto& [stage, value] : seconds.items())
    rows += row({xml_escaped(replaced(stage, "_", " ")), fmt::format("{:.2f} s", value.get<double>()),
                 fmt::format("<span class=\"bar\" style=\"width:{:.1f}em\"></span>",
                             longest > 0 ? 20 * value.get<double>() / longest : 0)},
                "td");
  return "<table>\n" + rows + row({"in all", fmt::format("{:.2f} s", total), ""}, "td") + "</table>\n";
}

std::string list_of(const json& lines) {
  std::string text;
  for (const json& line : lines) text += "<li>" + xml_escaped(line.get<std::string>()) + "</li>\n";
  return text.empty() ? text : "<ul>\n" + text + "</ul>\n";
}

std::string repairs(const json& report) {
  std::string text = list_of(report["reading"]["lines"]);
  if (report.contains("wrap")) {
    text += fmt::format("<p>The tree was built on a wrap; no point of it is farther than {} from the mesh.</p>\n",
                        number(report["wrap_distance"]));
  } else if (report.contains("repair") && !report["repair"]["lines"].empty()) {
    text += list_of(report["repair"]["lines"]);
  } else {
    text += "<p>None: the mesh is a solid as it is.</p>\n";
  }
  if (report.contains("self_intersections") && report["self_intersections"].is_number() &&
      report["self_intersections"] > 0)
    text +=
        fmt::format("<p>{} pairs of triangles cut or touch each other.</p>\n", number(report["self_intersections"]));
  return text;
}

std::string axis(const json& report) {
  if (!report.contains("medial_axis")) return {};
  std::string text = "<h2>Medial axis</h2>\n" + values_table(report["medial_axis"]);
  const json& gaps = report["gap_repair"];
  return text + fmt::format(
                    "<p>From {} surface points, {} of which gap repair added; {} faces of Voronoi cells still "
                    "cross a gap between parts of the surface.</p>\n",
                    number(report["surface_points"]), number(gaps["points_added"]),
                    number(gaps["faces_still_crossing"]));
}

constexpr const char* kTerms = R"(<dl>
<dt>inaccuracy</dt><dd>of a sphere: how far from the solid the farthest of its points is, at most</dd>
<dt>R</dt><dd>the radius of the ball around the whole mesh</dd>
<dt>cluster</dt><dd>triangles that make one flat or smooth part of the surface, up to its sharp edges</dd>
<dt>level</dt><dd>0 is the root, one sphere around everything; each further level replaces spheres by their children</dd>
<dt>conservative</dt><dd>every point of the surface lies in all spheres of some path from the root to a leaf, so no contact
is missed; proven for the numbers in the file</dd>
</dl>
)";

}  // namespace

std::string to_html(const BuildPage& page) {
  const json& report = page.report;
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>" +
      xml_escaped(page.title) + ": sphere-tree</title>\n<style>" + kStyle + "</style></head><body>\n";
  text += "<h1>" + xml_escaped(page.title) + "</h1>\n<p><code>" + xml_escaped(page.command_line) + "</code></p>\n";
  text += "<div class=\"certificate\">" + xml_escaped(page.certificate) + "</div>\n";
  if (!page.doubts.empty()) text += "<div class=\"doubts\">" + xml_escaped(page.doubts) + "</div>\n";
  if (!page.picture.empty())
    text += "<p><img alt=\"mesh, surface points, medial axis and levels of the tree\" src=\"data:image/png;base64," +
            base64(page.picture) + "\"></p>\n";
  text += "<h2>Levels</h2>\n" + levels_table(report) + "<p>" + page.plot + "</p>\n";
  text += "<h2>Mesh</h2>\n" + values_table(report["mesh"]);
  text += "<h2>Repairs</h2>\n" + repairs(report);
  text += axis(report);
  text += "<h2>Options</h2>\n" + values_table(report["options"]);
  text += "<h2>Time</h2>\n" + timings(report["seconds"]);
  text += std::string("<h2>Terms</h2>\n") + kTerms;
  return text + "<details><summary>The whole report as JSON</summary><pre>" + xml_escaped(report.dump(1)) +
         "</pre></details>\n</body></html>\n";
}

}  // namespace orchard::apps
