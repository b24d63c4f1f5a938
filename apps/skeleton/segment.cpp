#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

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

std::string part_name(const std::filesystem::path& mesh, Index part) {
  return named(mesh, fmt::format("-segment-{:03}.ply", part));
}

// Those of the names of parts that are taken in the folder: how many parts there will be is not known before.
std::vector<std::string> taken_part_names(const SegmentCommand& command) {
  const std::string start = named(command.axis.mesh, "-segment-"), end = ".ply";
  std::vector<std::string> taken;
  std::error_code ignored;
  if (!command.meshes) return taken;
  for (const auto& entry : std::filesystem::directory_iterator(command.axis.folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(start) || !name.ends_with(end) || name.size() <= start.size() + end.size()) continue;
    const auto digits = name.substr(start.size(), name.size() - start.size() - end.size());
    if (digits.find_first_not_of("0123456789") == std::string::npos) taken.push_back(name);
  }
  std::sort(taken.begin(), taken.end());
  return taken;
}

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
    write_file(outputs.add(part_name(mesh, part), what), to_ply(part_mesh(parts, part), {}, {}));
  }
}

}  // namespace

void check_options(const SegmentCommand& command) { check_options(command.axis); }

ExitCode segment(const SegmentCommand& command) {
  check_options(command);
  const MedialCommand& axis_command = command.axis;
  const Destination destination = destination_of(axis_command, named(axis_command.mesh, "-segments.json"), "segment",
                                                 kSegmentEndings, taken_part_names(command));
  ProgressBar bar(!axis_command.output.quiet && !axis_command.output.json);
  const SolidAxis axis = solid_axis(axis_command, bar.callback(), bar);
  const Stopwatch watch;
  const SurfaceParts parts = surface_parts(axis.solid.surface, axis.mesh, command.options, bar.callback());
  StageTimes seconds = axis_seconds(axis);
  seconds.emplace_back("parts", watch.seconds());
  bar.clear();
  const SegmentReport report{.command = command, .axis = axis, .parts = parts};
  Outputs outputs(destination);
  write_segment_files(command, parts, outputs);
  finish(axis_command, "segment", axis, seconds, to_json(report), outputs, [&] { print(report); });
  if (const std::string warning = axis_warning(axis_command, axis); !warning.empty())
    fmt::print(stderr, "orchard: warning: {}: {}\n", axis_command.mesh.string(), warning);
  return kSucceeded;
}

}  // namespace orchard::apps
