#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/mesh_arrays.h"
#include "output/outputs.h"
#include "skeleton/segment_report.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/arrays_writer.h"
#endif

namespace orchard::apps {
namespace {

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
  const Destination destination =
      destination_of(axis_command, named(axis_command.mesh, "-segments.json"), "segment", kSegmentEndings);
  ProgressBar bar(!axis_command.output.quiet && !axis_command.output.json);
  const SolidAxis axis = solid_axis(axis_command, bar.callback(), bar);
  const Stopwatch watch;
  const SurfaceParts parts = surface_parts(axis.solid.surface, axis.mesh, command.options, bar.callback());
  StageTimes seconds = axis.build.seconds;
  seconds.emplace_back("parts", watch.seconds());
  bar.clear();
  const SegmentReport report{.command = command, .axis = axis, .parts = parts};
  Outputs outputs(destination);
  write_segment_files(command, parts, outputs);
  finish(axis_command, "segment", axis, seconds, to_json(report), outputs, [&] { print(report); });
  if (const std::string warning = axis_warning(axis); !warning.empty())
    fmt::print(stderr, "orchard: warning: {}: {}\n", axis_command.mesh.string(), warning);
  return kSucceeded;
}

}  // namespace orchard::apps
