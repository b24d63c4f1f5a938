#include "offset/offset_report.h"

#include <fmt/core.h>

#include "input/reading_report.h"
#include "output/json_values.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

const char* name_of(OffsetSide side) {
  if (side == OffsetSide::both) return "both";
  return side == OffsetSide::inside ? "inside" : "outside";
}

}  // namespace

Broken broken(const OffsetReport& report) {
  Broken result;
  const OffsetMesh& offset = report.offset;
  if (report.wall && !(*report.min_wall >= *report.wall))
    result.what.push_back(
        fmt::format("the wall is proven to be {:.6g} thick only, not {:g}", *report.min_wall, *report.wall));
  if (offset.error() > offset.tolerance)
    result.what.push_back(
        fmt::format("distances are proven to be within {:.6g} only, not {:.6g}", offset.error(), offset.tolerance));
  if (!report.mesh.solid()) result.what.push_back("the result is no solid: " + report.mesh.faults());
  if (!result.none()) result.remedy = "take a larger --tolerance, or wrap the mesh with --wrap";
  return result;
}

json to_json(const OffsetReport& report) {
  const OffsetMesh& offset = report.offset;
  const Broken faults = broken(report);
  return {{"side", report.wall ? "hollow" : name_of(report.side)},
          {"unit", report.unit.empty() ? json() : json(report.unit)},
          {"distance", offset.distance},
          {"distances", {offset.min_distance, offset.max_distance}},
          {"error", offset.error()},
          {"error_over_diagonal", offset.error() / report.diagonal},
          {"tolerance", offset.tolerance},
          {"tolerance_over_diagonal", offset.tolerance / report.diagonal},
          {"cell", offset.cell},
          {"nearest", point_json(offset.nearest)},
          {"farthest", point_json(offset.farthest)},
          {"wall", report.wall ? json(*report.wall) : json()},
          {"min_wall", report.min_wall ? json(*report.min_wall) : json()},
          {"vertices", report.mesh.vertices},
          {"triangles", report.mesh.triangles},
          {"components", report.mesh.components},
          {"area", report.mesh.area},
          {"volume", report.mesh.volume},
          {"solid", report.mesh.solid()},
          {"promise", {{"kept", faults.none()}, {"broken", faults.what}}}};
}

void print(const OffsetReport& report) {
  const OffsetMesh& offset = report.offset;
  const std::string unit = with_unit(report.unit);
  fmt::print("{} triangles in {} component{}, volume {:.8g}{}\n", report.mesh.triangles, report.mesh.components,
             report.mesh.components == 1 ? "" : "s", report.mesh.volume, unit.empty() ? "" : unit + "^3");
  if (report.wall)
    fmt::print("walls are proven to be {:.6g}{} thick or more, {:g}{} was asked for\n", *report.min_wall, unit,
               *report.wall, unit);
  fmt::print(
      "all places of the {} are proven to be {:.6g} to {:.6g}{} from the surface: within {:.4g}{} ({:.3g} % of the "
      "diagonal) of {:.6g}{}; the tolerance is {:.4g} ({:.3g} %)\n",
      report.wall ? "cavity" : "offset", offset.min_distance, offset.max_distance, unit, offset.error(), unit,
      100 * offset.error() / report.diagonal, offset.distance, unit, offset.tolerance,
      100 * offset.tolerance / report.diagonal);
}

}  // namespace orchard::apps
