#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/mesh_arrays.h"
#include "output/json_values.h"
#include "output/outputs.h"
#include "report/report_page.h"
#include "skeleton/segment_report.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/arrays_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr std::array kSegmentEndings{"-segments.ply", "-segments.csv", "-segments.vtp"};

std::vector<MeshArray> label_arrays(const SurfaceParts& parts) {
  std::vector<MeshArray> arrays{{"part", {}}, {"sheet", {}}, {"region", {}}, {"triangle", {}}, {"ball_radius", {}}};
  const auto number = [](Index index) { return index == kNone ? -1.0 : static_cast<double>(index); };
  for (std::size_t t = 0; t < parts.parts_of.size(); ++t) {
    const SurfaceParts::Part& part = parts.parts[parts.parts_of[t]];
    arrays[0].values.push_back(number(parts.parts_of[t]));
    arrays[1].values.push_back(number(part.sheet));
    arrays[2].values.push_back(number(part.region));
    arrays[3].values.push_back(number(parts.of_triangle[t]));
    arrays[4].values.push_back(parts.radii[t]);
  }
  return arrays;
}

void write_segment_files(const SegmentCommand& command, const SurfaceParts& parts, Outputs& outputs) {
  const std::filesystem::path& mesh = command.axis.mesh;
  const std::vector<MeshArray> arrays = label_arrays(parts);
  write_file(outputs.add(named(mesh, "-segments.ply"), "the mesh, divided, with the part of each triangle"),
             to_ply(parts.mesh, {}, arrays));
  write_file(outputs.add(named(mesh, "-segments.csv"), "the parts with their areas"), to_csv(parts));
#ifdef ORCHARD_HAS_VIZ
  if (command.axis.views) {
    ViewArrays views;
    for (const MeshArray& array : arrays) views.push_back({array.name, array.values});
    write_mesh_with_arrays(outputs.add(named(mesh, "-segments.vtp"), "the same; open it in ParaView"), parts.mesh, {},
                           views);
  }
#endif
  for (Index part = 0; command.meshes && part < parts.parts.size(); ++part) {
    const std::string what = part == 0 ? "the largest part; the others likewise" : "";
    write_file(outputs.add(named(mesh, fmt::format("-segment-{:03}.ply", part)), what),
               to_ply(part_mesh(parts, part), {}, {}));
  }
}

}  // namespace

void check_options(const SegmentCommand& command) { check_options(command.axis); }

ExitCode segment(const SegmentCommand& command) {
  check_options(command);
  const MedialCommand& axis_command = command.axis;
  check_input(axis_command.mesh);
  const Destination destination{.folder = axis_command.folder,
                                .report = named(axis_command.mesh, "-segments.json"),
                                .provenance = provenance_of(axis_command.output.run, std::array{axis_command.mesh}),
                                .force = axis_command.output.force};
  std::vector<std::string> names;
  for (const char* ending : kSegmentEndings) names.push_back(named(axis_command.mesh, ending));
  names.push_back(page_name(axis_command.mesh, "segment"));
  check_outputs(destination, names, std::array{axis_command.mesh});
  const bool talk = !axis_command.output.quiet && !axis_command.output.json;
  ProgressBar bar(talk);
  const SolidAxis axis = solid_axis(axis_command, bar.callback(), bar);
  const Stopwatch watch;
  const SurfaceParts parts = surface_parts(axis.solid.surface, axis.mesh, command.options, bar.callback());
  StageTimes seconds = axis.build.seconds;
  seconds.emplace_back("parts", watch.seconds());
  bar.clear();
  const SegmentReport report{.command = command, .axis = axis, .parts = parts};
  Outputs outputs(destination);
  write_segment_files(command, parts, outputs);
  json document = to_json(report);
  document["seconds"] = seconds_json(seconds);
  add_solid_json(axis.solid, document);
  outputs.add_report(document, "this report as JSON");
  if (axis_command.report) write_report_page(page_name(axis_command.mesh, "segment"), {.report = document}, outputs);
  outputs.commit();
  if (axis_command.output.json) fmt::print("{}\n", document.dump(2));
  if (talk) {
    print(report);
    for (const auto& [stage, time] : seconds) fmt::print("  {:<18} {:>8.2f} s\n", stage, time);
    outputs.print();
  }
  if (const std::string warning = axis_warning(axis); !warning.empty())
    fmt::print(stderr, "orchard: warning: {}: {}\n", axis_command.mesh.string(), warning);
  return kSucceeded;
}

}  // namespace orchard::apps
