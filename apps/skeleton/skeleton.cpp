#include <fmt/core.h>

#include <array>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "orchard/geometry/atomic_file.h"
#include "output/outputs.h"
#include "skeleton/skeleton_report.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/skeleton_writer.h"
#endif

namespace orchard::apps {
namespace {

constexpr std::array kSkeletonEndings{"-skeleton.swc", "-skeleton.graphml", "-skeleton.obj", "-skeleton.csv",
                                      "-skeleton.vtp"};

void write_skeleton_files(const SkeletonCommand& command, const CurveSkeleton& skeleton, Outputs& outputs) {
  const auto add = [&](const char* ending, const char* what) {
    return outputs.add(named(command.axis.mesh, ending), what);
  };
  write_file(add("-skeleton.swc", "the skeleton as a forest with radii"), to_swc(skeleton));
  write_file(add("-skeleton.graphml", "its nodes and curves as a graph"), to_graphml(skeleton));
  write_file(add("-skeleton.obj", "its lines"), to_obj(skeleton));
  write_file(add("-skeleton.csv", "its vertices along each curve, with radii"), to_csv(skeleton));
#ifdef ORCHARD_HAS_VIZ
  if (command.axis.views) write_curve_skeleton(add("-skeleton.vtp", "the same; open it in ParaView"), skeleton);
#endif
}

}  // namespace

void check_options(const SkeletonCommand& command) { check_options(command.axis); }

ExitCode skeleton(const SkeletonCommand& command) {
  check_options(command);
  const MedialCommand& axis_command = command.axis;
  const Destination destination =
      destination_of(axis_command, named(axis_command.mesh, "-skeleton.json"), "skeleton", kSkeletonEndings);
  ProgressBar bar(!axis_command.output.quiet && !axis_command.output.json);
  const SolidAxis axis = solid_axis(axis_command, bar.callback(), bar);
  const Stopwatch watch;
  const CurveSkeleton found = curve_skeleton(axis.solid.surface, axis.mesh, command.options, bar.callback());
  StageTimes seconds = axis_seconds(axis);
  seconds.emplace_back("skeleton", watch.seconds());
  bar.clear();
  const SkeletonReport report{
      .command = command, .axis = axis, .skeleton = found, .found = topology(medial_mesh(found))};
  const Broken promise = broken(report);
  Outputs outputs(destination);
  write_skeleton_files(command, found, outputs);
  finish(axis_command, "skeleton", axis, seconds, to_json(report), outputs, [&] { print(report); });
  if (!promise.none()) fmt::print(stderr, "orchard: {}: {}\n", axis_command.mesh.string(), in_one_line(promise));
  return exit_code(promise, axis_command.accept);
}

}  // namespace orchard::apps
