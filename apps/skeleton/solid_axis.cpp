#include "skeleton/solid_axis.h"

#include <fmt/core.h>

#include <utility>

#include "input/input_file.h"
#include "input/reading_report.h"
#include "medial/medial_report.h"
#include "medial/medial_warning.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/outside_solid.h"
#include "orchard/medial/read_axis.h"
#include "output/json_values.h"
#include "output/promises.h"
#include "report/report_page.h"

namespace orchard::apps {
namespace {

// Centres of balls may be outside the solid by this fraction of the bounding radius: those on its edges are, by
// rounding. Of the others, a file may have this share: coarse axes of other systems do.
constexpr double kOutside = 1e-4, kOutsideShare = 0.02;

MedialFindings findings_of(const SolidAxis& axis) { return {.found = axis.found, .wanted = axis.wanted}; }

SolidAxis built_axis(const MedialCommand& command, SolidMesh solid, const Progress& progress) {
  const MedialBuildOptions options = build_options(command.tuning);
  MedialBuildInput input;
  if (command.outside) {
    SolidMesh outside = outside_of(solid, command.outside_radius);
    input.sampling = sample_outside(solid.surface, outside.surface, options.sampling, progress);
    solid = std::move(outside);
  }
  MedialBuild build = build_medial_axis(solid.surface, options, progress, std::move(input));
  MedialMesh mesh = medial_mesh(build.axis);
  return {.solid = std::move(solid),
          .build = std::move(build),
          .mesh = std::move(mesh),
          .notes = {},
          .found = {},
          .wanted = {}};
}

void require_axis_inside(const MedialCommand& command, const Surface& surface, const MedialMesh& mesh) {
  if (mesh.edges.empty() && mesh.size() > 1)
    throw InputError(command.axis.string() +
                     ": has balls alone, without edges and triangles; orchard medial --axis with --connect and "
                     "--export ma connects them");
  surface.self_intersections();  // which signed distances need
  Index outside = 0;
  Point first = Point::Zero();
  for (const Point& center : mesh.centers) {
    if (!(surface.signed_distance(center) > kOutside * surface.bounding_radius())) continue;
    if (outside == 0) first = center;
    ++outside;
  }
  if (outside <= kOutsideShare * mesh.size()) return;
  throw InputError(fmt::format(
      "{}: is not an axis of {}: {} of {} centres are {}, the first one at {:.6g} {:.6g} {:.6g}; give the axis of this "
      "mesh{}, made with the same options for repair, --scale and --side",
      command.axis.string(), command.mesh.string(), outside, mesh.size(),
      command.outside ? "inside the mesh or beyond the sphere around it" : "outside it", first.x(), first.y(),
      first.z(), command.outside ? "'s outside" : ""));
}

SolidAxis axis_of_file(const MedialCommand& command, ForeignAxis file, SolidMesh solid) {
  if (command.outside) solid = outside_of(solid, command.outside_radius);
  PlacedAxis placed = place_axis(solid.surface, std::move(file));
  require_axis_inside(command, solid.surface, placed.mesh);
  return {.solid = std::move(solid),
          .build = std::nullopt,
          .mesh = std::move(placed.mesh),
          .notes = std::move(placed.notes),
          .found = {},
          .wanted = {}};
}

}  // namespace

SolidMesh outside_of(const SolidMesh& solid, double radius) {
  return {.surface = Surface(outside_solid(solid.surface, radius)),
          .reading = solid.reading,
          .repair = {},
          .repair_distance = {},
          .wrap = {},
          .self_intersections = solid.self_intersections,
          .noise = solid.noise};
}

SolidAxis solid_axis(const MedialCommand& command, const Progress& progress, ProgressBar& bar) {
  const bool talk = !command.output.quiet && !command.output.json;
  std::optional<ForeignAxis> file;
  if (!command.axis.empty()) file = read_axis(command.axis);
  SolidMesh solid = load_solid(command.mesh, command.reading, progress);
  bar.clear();
  if (talk) print_solid(command.mesh, solid);
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, solid.surface.bounding_radius());
  SolidAxis axis = file ? axis_of_file(command, std::move(*file), std::move(solid))
                        : built_axis(command, std::move(solid), progress);
  axis.found = topology(axis.mesh);
  axis.wanted = solid_topology(axis.solid.surface);
  bar.clear();
  if (talk) {
    fmt::print("{}: {} triangles", command.mesh.string(), axis.solid.surface.mesh().triangles.size());
    if (command.outside)
      fmt::print(", with those of a sphere of {:.6g} bounding radii around its outside", command.outside_radius);
    fmt::print("\naxis{}: {} balls, {} edges, {} triangles\n", file ? " of " + command.axis.string() : "",
               axis.mesh.size(), axis.mesh.edges.size(), axis.mesh.triangles.size());
    for (const std::string& note : axis.notes) fmt::print("  {}\n", note);
  }
  return axis;
}

StageTimes axis_seconds(const SolidAxis& axis) { return axis.build ? axis.build->seconds : StageTimes{}; }

nlohmann::json axis_json(const MedialCommand& command, const SolidAxis& axis) {
  nlohmann::json json{{"file", axis.build ? nlohmann::json() : nlohmann::json(command.axis.string())},
                      {"vertices", axis.mesh.centers.size()},
                      {"triangles", axis.mesh.triangles.size()},
                      {"topology", to_json(axis.found)},
                      {"promise", axis.build ? to_json(axis.build->promise) : nlohmann::json()}};
  if (!axis.build) json["notes"] = axis.notes;
  return json;
}

Destination destination_of(const MedialCommand& command, const std::string& report, const char* typed,
                           std::span<const char* const> endings, const std::vector<std::string>& more_names) {
  std::vector<std::filesystem::path> inputs{command.mesh};
  if (!command.axis.empty()) inputs.push_back(command.axis);
  for (const std::filesystem::path& file : inputs) check_input(file);
  Destination destination{.folder = command.folder,
                          .report = report,
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  std::vector<std::string> names{page_name(command.mesh, typed)};
  for (const char* ending : endings) names.push_back(named(command.mesh, ending));
  names.insert(names.end(), more_names.begin(), more_names.end());
  check_outputs(destination, names, inputs);
  return destination;
}

void finish(const MedialCommand& command, const char* typed, const SolidAxis& axis, const StageTimes& seconds,
            nlohmann::json report, Outputs& outputs, const std::function<void()>& print) {
  report["seconds"] = seconds_json(seconds);
  add_solid_json(axis.solid, report);
  outputs.add_report(report, "this report as JSON");
  if (command.report) write_report_page(page_name(command.mesh, typed), {.report = report}, outputs);
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (command.output.quiet || command.output.json) return;
  print();
  for (const auto& [stage, time] : seconds) fmt::print("  {:<18} {:>8.2f} s\n", stage, time);
  outputs.print();
}

std::string axis_warning(const MedialCommand& command, const SolidAxis& axis) {
  if (axis.build) return medial_warning(axis.solid, *axis.build, findings_of(axis));
  if (axis.found == axis.wanted) return {};
  return fmt::format("the axis has {}, the solid {}: {}", in_words(axis.found), in_words(axis.wanted),
                     topology_remedy(command, axis));
}

std::string topology_remedy(const MedialCommand& command, const SolidAxis& axis) {
  if (axis.build) return topology_cause(axis.solid, *axis.build, findings_of(axis));
  return "give an axis with the topology of the solid, or leave out --axis " + command.axis.string();
}

}  // namespace orchard::apps
