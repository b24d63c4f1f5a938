#include <fmt/core.h>

#include <array>
#include <numbers>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "input/reading_report.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_arrays.h"
#include "output/outputs.h"
#include "report/report_page.h"
#include "thickness/thickness_report.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/arrays_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;

struct FileNames {
  std::string ply, csv, svg, vtp, report, page;
  explicit FileNames(const std::filesystem::path& mesh)
      : ply(named(mesh, "-thickness.ply")),
        csv(named(mesh, "-thickness.csv")),
        svg(named(mesh, "-thickness.svg")),
        vtp(named(mesh, "-thickness.vtp")),
        report(named(mesh, "-thickness.json")),
        page(page_name(mesh, "thickness")) {}
};

std::vector<double> in_degrees(std::vector<double> angles) {
  for (double& angle : angles) angle *= 180 / std::numbers::pi;
  return angles;
}

std::vector<MeshArray> arrays_of(const ThicknessValues& values) {
  return {{"ball_diameter", values.ball_diameter},
          {"thickness", values.thickness},
          {"contact_angle", in_degrees(values.contact_angle)},
          {"error", values.error}};
}

std::vector<double> as_numbers(const std::vector<Index>& indices) {
  std::vector<double> numbers;
  numbers.reserve(indices.size());
  for (const Index index : indices) numbers.push_back(index == kNone ? -1 : static_cast<double>(index));
  return numbers;
}

void write_files(const ThicknessCommand& command, const ThicknessReport& report, Outputs& outputs) {
  const FileNames names(command.mesh);
  const LocalThickness& thickness = report.thickness;
  const std::vector<MeshArray> of_vertices = arrays_of(thickness.at_vertices);
  std::vector<MeshArray> of_triangles = arrays_of(thickness.at_triangles);
  of_triangles.push_back({"triangle", as_numbers(thickness.of_triangle)});
  if (report.below) of_triangles.push_back({"thin_region", as_numbers(report.thin.of_triangle)});
  std::vector<std::string> comments;
  if (!report.unit.empty()) comments.push_back("unit " + report.unit);
  write_file(outputs.add(names.ply, "the mesh, divided, with ball_diameter and thickness"),
             to_ply(thickness.mesh, of_vertices, of_triangles, comments));
#ifdef ORCHARD_HAS_VIZ
  if (command.views) {
    const auto views = [](const std::vector<MeshArray>& arrays) {
      ViewArrays result;
      for (const MeshArray& array : arrays)
        result.push_back({array.name, array.values, array.name == "triangle" || array.name == "thin_region"});
      return result;
    };
    write_mesh_with_arrays(outputs.add(names.vtp, "the same; open it in ParaView"), thickness.mesh, views(of_vertices),
                           views(of_triangles), report.unit);
  }
#endif
  write_file(outputs.add(names.csv, "the histogram: area by thickness"), to_csv(report));
  write_plot(outputs.add(names.svg, "the same as a chart"), report);
}

}  // namespace

ExitCode thickness(const ThicknessCommand& command) {
  check_input(command.mesh);
  const FileNames names(command.mesh);
  Destination destination{.folder = command.folder,
                          .report = names.report,
                          .provenance = provenance_of(command.output.run, std::array{command.mesh}),
                          .force = command.output.force};
  keep_single_file(destination, std::array{names.ply, names.csv, names.svg, names.vtp});
  check_outputs(destination, std::array{names.ply, names.csv, names.svg, names.vtp, names.page},
                std::array{command.mesh});
  const bool talk = !command.output.quiet && !command.output.json;
  ProgressBar bar(talk);
  const SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  const Stopwatch watch;
  const LocalThickness found = local_thickness(solid.surface, command.options, bar.callback());
  const double seconds = watch.seconds();
  bar.clear();
  const std::optional<double> below = command.fail_below ? command.fail_below : command.below;
  const ThicknessReport report{.thickness = found,
                               .options = command.options,
                               .unit = solid.reading.unit,
                               .below = below,
                               .thin = thin_regions(found, below.value_or(0)),
                               .histogram = thickness_histogram(found, command.bins)};
  const bool too_thin = command.fail_below && !report.thin.regions.empty();

  Outputs outputs(destination);
  write_files(command, report, outputs);
  json document = to_json(report);
  document["too_thin"] = command.fail_below ? json(too_thin) : json();
  document["seconds"] = seconds;
  add_solid_json(solid, document);
  outputs.add_report(document, "this report as JSON");
  if (command.report) write_report_page(names.page, {.report = document}, outputs);
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", document.dump(2));
  if (talk) {
    print_solid(command.mesh, solid);
    print(report);
    fmt::print("{:.2f} s\n", seconds);
    outputs.print();
  }
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, solid.surface.bounding_radius());
  return too_thin ? kTooThin : kSucceeded;
}

}  // namespace orchard::apps
