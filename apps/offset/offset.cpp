#include <fmt/core.h>

#include <array>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "input/reading_report.h"
#include "offset/offset_report.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_arrays.h"
#include "output/outputs.h"
#include "report/report_page.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/arrays_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;

struct OffsetNames {
  std::string obj, ply, vtp, report;
  explicit OffsetNames(const std::filesystem::path& mesh)
      : obj(named(mesh, "-offset.obj")),
        ply(named(mesh, "-offset.ply")),
        vtp(named(mesh, "-offset.vtp")),
        report(named(mesh, "-offset.json")) {}
};

Destination check(const OffsetCommand& command) {
  check_input(command.mesh);
  check_options(command);
  const OffsetNames names(command.mesh);
  Destination destination{.folder = command.folder,
                          .report = names.report,
                          .provenance = provenance_of(command.output.run, std::array{command.mesh}),
                          .force = command.output.force};
  keep_single_file(destination, std::array{names.obj, names.ply, names.vtp});
  check_outputs(destination, std::array{names.obj, names.ply, names.vtp, page_name(command.mesh, "offset")},
                std::array{command.mesh});
  return destination;
}

// A shell on both sides may be of a surface that is no solid.
SolidMesh load_surface(const OffsetCommand& command, const Progress& progress) {
  const MeshOptions& reading = command.reading;
  if (command.side != OffsetSide::both || reading.strict || !reading.wrap.empty() || reading.fill_holes)
    return load_solid(command.mesh, reading, progress);
  RepairedMesh read = read_repaired(command.mesh, reading.input, reading.join);
  return {.surface = Surface(std::move(read.mesh), reading.ball),
          .reading = std::move(read.reading),
          .repair = std::move(read.repair),
          .repair_distance = read.distance,
          .wrap = {},
          .self_intersections = {}};
}

void write_files(const OffsetCommand& command, const TriangleMesh& mesh, const std::string& unit,
                 const Destination& destination, Outputs& outputs) {
  const OffsetNames names(command.mesh);
  write_obj(outputs.add(names.obj, "the result"), mesh);
  if (destination.single == names.ply) write_file(outputs.add(names.ply, "the result"), to_ply(mesh, {}, {}));
#ifdef ORCHARD_HAS_VIZ
  if (command.views || destination.single == names.vtp)
    write_mesh_with_arrays(outputs.add(names.vtp, "the same; open it in ParaView"), mesh, {}, {}, unit);
#endif
}

}  // namespace

void check_options(const OffsetCommand& command) {
  if (!command.distance && !command.hollow) throw InputError("--distance D or --hollow WALL is needed, in mesh units");
}

ExitCode offset(const OffsetCommand& command) {
  const Destination destination = check(command);
  const bool talk = !command.output.quiet && !command.output.json;
  ProgressBar bar(talk);
  const SolidMesh solid = load_surface(command, bar.callback());
  const Surface& surface = solid.surface;
  const Stopwatch watch;
  OffsetOptions options{
      .distance = command.distance.value_or(0), .side = command.side, .tolerance = command.tolerance / 100};
  HollowMesh made;
  if (command.hollow) {
    made = hollow_mesh(surface, *command.hollow, options, bar.callback());
  } else {
    made.cavity = offset_mesh(surface, options, bar.callback());
    made.mesh = std::move(made.cavity.mesh);
  }
  const double seconds = watch.seconds();
  bar.clear();
  const OffsetReport report{.offset = made.cavity,
                            .mesh = check_mesh(made.mesh),
                            .diagonal = surface.bounding_box().diagonal().norm(),
                            .side = command.side,
                            .wall = command.hollow,
                            .min_wall = command.hollow ? std::optional(made.min_wall) : std::nullopt,
                            .unit = solid.reading.unit};
  const Broken faults = broken(report);

  Outputs outputs(destination);
  write_files(command, made.mesh, report.unit, destination, outputs);
  json document = to_json(report);
  document["seconds"] = seconds;
  add_solid_json(solid, document);
  outputs.add_report(document, "this report as JSON");
  if (command.report) write_report_page(page_name(command.mesh, "offset"), {.report = document}, outputs);
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", document.dump(2));
  if (talk) {
    print_solid(command.mesh, solid);
    print(report);
    fmt::print("{:.2f} s\n", seconds);
    outputs.print();
  }
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, surface.bounding_radius());
  if (!faults.none()) fmt::print(stderr, "orchard: {}\n", in_one_line(faults));
  return exit_code(faults, command.accept);
}

}  // namespace orchard::apps
