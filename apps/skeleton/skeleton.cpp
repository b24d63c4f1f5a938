#include <fmt/core.h>

#include <array>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "orchard/geometry/atomic_file.h"
#include "output/json_values.h"
#include "output/outputs.h"
#include "report/report_page.h"
#include "skeleton/skeleton_report.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/skeleton_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;

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
  check_input(axis_command.mesh);
  const Destination destination{.folder = axis_command.folder,
                                .report = named(axis_command.mesh, "-skeleton.json"),
                                .provenance = provenance_of(axis_command.output.run, std::array{axis_command.mesh}),
                                .force = axis_command.output.force};
  std::vector<std::string> names;
  for (const char* ending : kSkeletonEndings) names.push_back(named(axis_command.mesh, ending));
  names.push_back(page_name(axis_command.mesh, "skeleton"));
  check_outputs(destination, names, std::array{axis_command.mesh});
  const bool talk = !axis_command.output.quiet && !axis_command.output.json;
  ProgressBar bar(talk);
  const SolidAxis axis = solid_axis(axis_command, bar.callback(), bar);
  const Stopwatch watch;
  const CurveSkeleton found = curve_skeleton(axis.solid.surface, axis.mesh, command.options, bar.callback());
  StageTimes seconds = axis.build.seconds;
  seconds.emplace_back("skeleton", watch.seconds());
  bar.clear();
  const SkeletonReport report{
      .command = command, .axis = axis, .skeleton = found, .found = topology(medial_mesh(found))};
  const Broken promise = broken(report);
  Outputs outputs(destination);
  write_skeleton_files(command, found, outputs);
  json document = to_json(report);
  document["seconds"] = seconds_json(seconds);
  add_solid_json(axis.solid, document);
  outputs.add_report(document, "this report as JSON");
  if (axis_command.report) write_report_page(page_name(axis_command.mesh, "skeleton"), {.report = document}, outputs);
  outputs.commit();
  if (axis_command.output.json) fmt::print("{}\n", document.dump(2));
  if (talk) {
    print(report);
    for (const auto& [stage, time] : seconds) fmt::print("  {:<18} {:>8.2f} s\n", stage, time);
    outputs.print();
  }
  if (!promise.none()) fmt::print(stderr, "orchard: {}: {}\n", axis_command.mesh.string(), in_one_line(promise));
  return exit_code(promise, axis_command.accept);
}

}  // namespace orchard::apps
