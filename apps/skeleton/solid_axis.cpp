#include "skeleton/solid_axis.h"

#include <fmt/core.h>

#include <array>

#include "input/input_file.h"
#include "input/reading_report.h"
#include "medial/medial_warning.h"
#include "orchard/geometry/outside_solid.h"
#include "output/json_values.h"
#include "report/report_page.h"

namespace orchard::apps {
namespace {

MedialFindings findings_of(const SolidAxis& axis) { return {.found = axis.found, .wanted = axis.wanted}; }

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
  SolidMesh solid = load_solid(command.mesh, command.reading, progress);
  bar.clear();
  if (talk) print_solid(command.mesh, solid);
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, solid.surface.bounding_radius());
  const MedialBuildOptions options = build_options(command.tuning);
  MedialBuildInput input;
  if (command.outside) {
    SolidMesh outside = outside_of(solid, command.outside_radius);
    input.sampling = sample_outside(solid.surface, outside.surface, options.sampling, progress);
    solid = std::move(outside);
  }
  MedialBuild build = build_medial_axis(solid.surface, options, progress, std::move(input));
  MedialMesh mesh = medial_mesh(build.axis);
  const Topology found = topology(mesh), wanted = solid_topology(solid.surface);
  bar.clear();
  if (talk) {
    fmt::print("{}: {} triangles", command.mesh.string(), solid.surface.mesh().triangles.size());
    if (command.outside)
      fmt::print(", with those of a sphere of {:.6g} bounding radii around its outside", command.outside_radius);
    fmt::print("\naxis: {} balls, {} edges, {} triangles\n", mesh.size(), mesh.edges.size(), mesh.triangles.size());
  }
  return {
      .solid = std::move(solid), .build = std::move(build), .mesh = std::move(mesh), .found = found, .wanted = wanted};
}

Destination destination_of(const MedialCommand& command, const std::string& report, const char* typed,
                           std::span<const char* const> endings) {
  check_input(command.mesh);
  const std::array inputs{command.mesh};
  Destination destination{.folder = command.folder,
                          .report = report,
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  std::vector<std::string> names{page_name(command.mesh, typed)};
  for (const char* ending : endings) names.push_back(named(command.mesh, ending));
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

std::string axis_warning(const SolidAxis& axis) { return medial_warning(axis.solid, axis.build, findings_of(axis)); }

std::string topology_remedy(const SolidAxis& axis) { return topology_cause(axis.solid, axis.build, findings_of(axis)); }

}  // namespace orchard::apps
