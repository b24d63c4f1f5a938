#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "input/load_solid.h"
#include "input/reading_report.h"
#include "medial/compared_axes.h"
#include "medial/medial_table.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/structure.h"
#include "output/outputs.h"
#include "output/report.h"
#include "output/stamp.h"
#include "report/report_page.h"
#include "report/report_plots.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::vector<fs::path> inputs_of(const CompareCommand& command) {
  std::vector<fs::path> inputs{command.mesh};
  inputs.insert(inputs.end(), command.files.begin(), command.files.end());
  return inputs;
}

std::string csv_name(const CompareCommand& command) { return named(command.mesh, "-compare.csv"); }
std::string picture_name(const CompareCommand& command) { return named(command.mesh, "-compare.png"); }
std::string axis_name(const CompareCommand& command, Index balls) {
  return named(command.mesh, fmt::format("-orchard-{}.ma", balls));
}

// What can be refused before anything is measured; then where the files go.
Destination check(const CompareCommand& command, const std::vector<ForeignAxis>& axes) {
  const std::vector<fs::path> inputs = inputs_of(command);
  Destination destination{.folder = command.folder,
                          .report = named(command.mesh, "-compare.json"),
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  for (const auto* file : {&command.plot, &command.csv})
    if (!file->empty()) check_output(*file, inputs);
  if (!command.csv.empty()) rows_of_others(command.csv, command.mesh.stem().string());
  if (command.folder.empty()) return destination;
  std::vector<std::string> names{csv_name(command), picture_name(command), page_name(command.mesh, "compare")};
  for (const ForeignAxis& axis : axes) {
    const Index size = axis.mesh.size();
    names.push_back(axis_name(command, command.vertices == 0 ? size : std::min(command.vertices, size)));
  }
  check_outputs(destination, names, inputs);
  return destination;
}

json axis_json(const ComparedAxis& axis) {
  json row{{"file", axis.name},
           {"balls", axis.mesh.size()},
           {"edges", axis.mesh.edges.size()},
           {"triangles", axis.mesh.triangles.size()},
           {"quality", to_json(axis.judgement)}};
  if (axis.own) return row;
  row["balls_of_file"] = axis.whole;
  row["simplified"] = axis.simplified;
  row["notes"] = axis.notes;
  return row;
}

json report_of(const CompareCommand& command, const SolidMesh& solid, const std::vector<ComparedAxis>& axes) {
  json report{{"mesh", mesh_json(solid.surface)},
              {"vertices", command.vertices == 0 ? json() : json(command.vertices)},
              {"axes", json::array()},
              {"own_axes", json::array()}};
  for (const ComparedAxis& axis : axes) report[axis.own ? "own_axes" : "axes"].push_back(axis_json(axis));
  add_solid_json(solid, report);
  return report;
}

void print_compared(const std::vector<ComparedAxis>& axes) {
  fmt::print("two-sided distance of surface and envelope, % of the diagonal, at equal numbers of balls\n");
  fmt::print("{:>7} {:>12} {:>12} {:>12}  {:<9} {}\n", "balls", "max", "mean", "open, proven", "topology", "axis");
  for (const ComparedAxis& axis : axes) {
    const MedialQuality& quality = axis.judgement.quality;
    fmt::print("{:>7} {:>12.4f} {:>12.5f} {:>12.4f}  {:<9} {}{}\n", axis.mesh.size(), 100 * quality.hausdorff.max,
               100 * quality.hausdorff.mean, 100 * quality.coverage_upper,
               quality.found == quality.wanted ? "right" : "WRONG", axis.name,
               axis.simplified ? fmt::format(" (simplified from {})", axis.whole) : std::string());
  }
  for (const ComparedAxis& axis : axes)
    for (const std::string& note : axis.notes) fmt::print("{}: {}\n", axis.name, note);
}

// Everything in the folder but the report.
void write_files(const CompareCommand& command, const Surface& surface, const std::vector<ComparedAxis>& axes,
                 const std::string& table, Outputs& outputs) {
  write_file(outputs.add(csv_name(command), "every measure of every axis"), table);
  for (const ComparedAxis& axis : axes)
    if (axis.own)
      write_file(outputs.add(axis_name(command, axis.mesh.size()), "orchard's axis of this size"),
                 to_ma(axis.mesh) + to_structure_section(medial_structure(axis.mesh)));
  draw_compared(picture_name(command), command.up, surface, axes, outputs);
}

}  // namespace

void compare_axes(const CompareCommand& command) {
  for (const fs::path& file : inputs_of(command)) check_input(file);
  std::vector<ForeignAxis> read;
  for (const fs::path& file : command.files) read.push_back(read_axis(file));
  const Destination destination = check(command, read);
  const bool talk = !command.output.quiet && !command.output.json;
  ProgressBar bar(talk);
  const SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  bar.clear();
  if (talk) print_solid(command.mesh, solid);
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, solid.surface.bounding_radius());
  const std::vector<ComparedAxis> axes = compared_axes(command, solid.surface, std::move(read), bar.callback());
  bar.clear();
  json report = report_of(command, solid, axes);
  const std::string model = command.mesh.stem().string(), table = compared_csv(axes, model);
  std::optional<Outputs> outputs;
  if (!command.folder.empty()) {
    outputs.emplace(destination);
    write_files(command, solid.surface, axes, table, *outputs);
    outputs->add_report(report, "this report as JSON");
    if (command.report)
      write_report_page(page_name(command.mesh, "compare"), page_of(report, outputs->take(picture_name(command), true)),
                        *outputs);
    outputs->commit();
  } else {
    report["provenance"] = to_json(destination.provenance);
  }
  const std::string line = line_of(destination.provenance);
  std::optional<Writing> writing;
  if (!outputs) writing.emplace();  // they are of that kind themselves
  if (!command.plot.empty())
    write_file(command.plot, stamped(plot::to_svg(report_plots("compare_axes", report), 2), "plot.svg", line));
  if (!command.csv.empty())
    write_file(command.csv, stamped(with_other_rows(table, rows_of_others(command.csv, model)), "table.csv", line));
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (!talk) return;
  print_compared(axes);
  if (outputs) outputs->print();
  if (!command.plot.empty()) fmt::print("  {}  (distances against balls)\n", command.plot.string());
  if (!command.csv.empty()) fmt::print("  {}  (the rows of this mesh and of others)\n", command.csv.string());
}

}  // namespace orchard::apps
