#include "input/reading_report.h"

#include <fmt/core.h>

#include "input/standard_input.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"

namespace orchard::apps {

using nlohmann::json;

namespace {

json points_json(const PointsReading& points) {
  return {{"points", points.points},
          {"spacing", points.spacing},
          {"mean_from_points", points.mean_from_points},
          {"max_from_points", points.max_from_points},
          {"max_to_points", points.max_to_points}};
}

}  // namespace

void print_reading(const std::filesystem::path& file, const MeshReadReport& reading) {
  for (const std::string& line : reading.lines()) fmt::print("{}: {}\n", shown(file), line);
}

std::string with_unit(const std::string& unit) { return unit.empty() ? "" : " " + unit; }

json reading_json(const MeshReadReport& reading) {
  const auto occurrences = [](const MeshReadReport::Occurrences& what) {
    return json{{"count", what.count}, {"first", what.count > 0 ? json(what.first) : json()}};
  };
  return {{"faces_skipped", occurrences(reading.faces_skipped)},
          {"vertices_skipped", occurrences(reading.vertices_skipped)},
          {"polygons_overlapping", occurrences(reading.polygons_overlapping)},
          {"polygons_triangulated", reading.polygons_triangulated},
          {"facets_promised", reading.facets_promised},
          {"facets_found", reading.facets_found},
          {"bytes_left_out", reading.bytes_left_out},
          {"attribute_bytes", reading.attribute_bytes},
          {"header_lines", reading.header_lines},
          {"volume_cells", reading.volume_cells},
          {"cells_beside", reading.cells_beside},
          {"lines_skipped", reading.lines_skipped},
          {"curved_cells", reading.curved_cells},
          {"unit", reading.unit.empty() ? json() : json(reading.unit)},
          {"scale", reading.scale},
          {"from_points", reading.from_points ? points_json(*reading.from_points) : json()},
          {"lines", reading.lines()}};
}

void require_complete(const std::string& name, const MeshReadReport& reading) {
  if (reading.complete()) return;
  throw InputError(name + ": the file cannot be read without changes: " + reading.faults().front() +
                   "; leave out --strict to accept them");
}

std::string hole_warning(const MeshRepairReport& repair, const RepairDistance& distance, double bounding_radius) {
  const double moved = distance.to_input.upper / bounding_radius;
  if (repair.holes_filled == 0 || !(moved > tolerance::kFarFill)) return {};
  return fmt::format(
      "filling {} moved the surface by up to {:.3g} % of the bounding radius: if an opening is meant there, "
      "--fill-holes sets how wide a hole may be, and --wrap or another mesh keeps what is open",
      repair.holes_filled == 1 ? std::string("a hole") : fmt::format("{} holes", repair.holes_filled), 100 * moved);
}

void print_warning(const std::filesystem::path& file, const std::string& warning) {
  fmt::print(stderr, "orchard: warning: {}: {}\n", shown(file), warning);
}

void print_hole_warning(const std::filesystem::path& file, const MeshRepairReport& repair,
                        const RepairDistance& distance, double bounding_radius) {
  const std::string warning = hole_warning(repair, distance, bounding_radius);
  if (!warning.empty()) print_warning(file, warning);
}

}  // namespace orchard::apps
