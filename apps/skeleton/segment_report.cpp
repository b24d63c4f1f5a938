#include "skeleton/segment_report.h"

#include <fmt/core.h>

#include <algorithm>

#include "medial/medial_report.h"
#include "output/json_values.h"
#include "output/report.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr std::size_t kPrintedParts = 12;  // that the table has; the report has all

double whole_area(const SurfaceParts& parts) {
  double area = 0;
  for (const SurfaceParts::Part& part : parts.parts) area += part.area;
  return area;
}

json numbered(Index index) { return index == kNone ? json() : json(index); }

const char* name_of(PartKind kind) {
  return kind == PartKind::sheets ? "sheets" : kind == PartKind::necks ? "necks" : "both";
}

}  // namespace

json to_json(const SegmentReport& report) {
  const PartOptions& options = report.command.options;
  json parts = json::array(), necks = json::array();
  for (const SurfaceParts::Part& part : report.parts.parts)
    parts.push_back({{"area", part.area},
                     {"triangles", part.triangles},
                     {"patches", part.patches},
                     {"max_radius", part.max_radius},
                     {"sheet", numbered(part.sheet)},
                     {"region", numbered(part.region)}});
  for (const SurfaceParts::Neck& neck : report.parts.necks)
    necks.push_back({{"regions", {neck.a, neck.b}},
                     {"place", point_json(neck.place)},
                     {"radius", neck.radius},
                     {"significance", neck.significance}});
  return {{"mesh", mesh_json(report.axis.solid.surface)},
          {"by", name_of(options.kind)},
          {"neck", options.neck},
          {"min_area_share", options.min_area},
          {"area", whole_area(report.parts)},
          {"triangles", report.parts.mesh.triangles.size()},
          {"parts", std::move(parts)},
          {"regions", report.parts.regions},
          {"necks", std::move(necks)},
          {"topology", to_json(report.axis.found)},
          {"topology_of_solid", to_json(report.axis.wanted)},
          {"axis", axis_json(report.command.axis, report.axis)}};
}

void print(const SegmentReport& report) {
  const SurfaceParts& parts = report.parts;
  const double total = whole_area(parts);
  fmt::print("{} parts of {} triangles, by {}; {} regions with {} necks between them\n", parts.parts.size(),
             parts.mesh.triangles.size(), name_of(report.command.options.kind), parts.regions, parts.necks.size());
  fmt::print(" part         area   % of all   triangles  patches   max radius\n");
  for (std::size_t i = 0; i < std::min(parts.parts.size(), kPrintedParts); ++i) {
    const SurfaceParts::Part& part = parts.parts[i];
    fmt::print("{:5} {:12.6g} {:10.2f} {:11} {:8} {:12.6g}\n", i, part.area, 100 * part.area / total, part.triangles,
               part.patches, part.max_radius);
  }
  if (parts.parts.size() > kPrintedParts)
    fmt::print("and {} more, which the report has\n", parts.parts.size() - kPrintedParts);
  if (parts.necks.empty()) return;
  fmt::print(" neck       radius  significance   where\n");
  for (std::size_t i = 0; i < std::min(parts.necks.size(), kPrintedParts); ++i) {
    const SurfaceParts::Neck& neck = parts.necks[i];
    fmt::print("{:5} {:12.6g} {:13.3f}   {:.6g} {:.6g} {:.6g}\n", i, neck.radius, neck.significance, neck.place.x(),
               neck.place.y(), neck.place.z());
  }
  if (parts.necks.size() > kPrintedParts)
    fmt::print("and {} more, which the report has\n", parts.necks.size() - kPrintedParts);
}

std::string to_csv(const SurfaceParts& parts) {
  const double total = whole_area(parts);
  const auto number = [](Index index) { return index == kNone ? std::string("-1") : std::to_string(index); };
  std::string text = "part,area,area_percent,triangles,patches,max_radius,sheet,region\n";
  for (std::size_t i = 0; i < parts.parts.size(); ++i) {
    const SurfaceParts::Part& part = parts.parts[i];
    text += fmt::format("{},{},{},{},{},{},{},{}\n", i, part.area, 100 * part.area / total, part.triangles,
                        part.patches, part.max_radius, number(part.sheet), number(part.region));
  }
  return text;
}

}  // namespace orchard::apps
