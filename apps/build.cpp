#include <fmt/core.h>

#include <fstream>

#include "build_plot.h"
#include "commands.h"
#include "console.h"
#include "load_solid.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/tree_io.h"
#include "output_folder.h"
#include "report.h"
#include "sphere_lists.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/render.h"
#include "orchard/viz/vtk_writer.h"
#endif

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

std::string_view as_text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Returns the files to tell the user about, each with what it is.
using Written = std::vector<std::pair<fs::path, std::string>>;

Written write_trees(const BuildCommand& command, const BuildResult& result) {
  Written written;
  const auto write = [&](const char* extension, std::string_view bytes, const char* what) {
    const fs::path file = in_folder(command.folder, command.mesh, extension);
    write_file(file, bytes);
    written.emplace_back(file, what);
  };
  write(".orchard", as_text(runtime::serialize(result.packed)), "the sphere-tree for the run-time");
  write(".sph", to_sph(result.tree), "the sphere-tree as text");
  const SphereLists lists = levels_of(result.tree);
  for (const std::string& format : command.exports) {
    if (format == "json") write("-spheres.json", to_json(lists).dump(1) + "\n", "the spheres of each level");
    if (format == "urdf")
      write(".urdf", to_urdf(lists, command.export_level.value_or(result.tree.depth()), command.mesh.stem().string()),
            "a level's spheres as a link's collision geometry");
  }
  return written;
}

fs::path wrap_file(const BuildCommand& command) { return in_folder(command.folder, command.mesh, kWrapEnding); }

void write_wrap(const BuildCommand& command, const TriangleMesh& wrap, Written& written) {
  const fs::path file = wrap_file(command);
  write_obj(file, wrap);
  written.emplace_back(file, "the wrap, which everything else was built on");
}

#ifdef ORCHARD_HAS_VIZ
UpAxis parse_up(const std::string& up) { return up == "x" ? UpAxis::x : up == "z" ? UpAxis::z : UpAxis::y; }

void write_views(const BuildCommand& command, const Surface& surface, const BuildResult& result, Written& written) {
  const PipelineValues values{.surface = &surface,
                              .sampling = result.axis ? &result.sampling : nullptr,
                              .axis = result.axis ? &*result.axis : nullptr,
                              .tree = &result.tree};
  if (command.views) {
    write_pipeline(command.folder, values);
    written.emplace_back(command.folder / "pipeline.vtm", "open this in ParaView: all views at once");
  }
  if (!command.picture) return;
  const fs::path png = in_folder(command.folder, command.mesh, ".png");
  PipelinePicture picture;
  picture.values = values;
  picture.title = command.mesh.stem().string();
  picture.up = parse_up(command.up);
  const PictureStatus status = draw_pipeline(png, picture);
  if (status) {
    written.emplace_back(png, "the pipeline in one picture");
  } else {
    fmt::print(stderr, "orchard: no picture was made: {}\n", status.reason);
  }
}
#else
void write_views(const BuildCommand& command, const Surface&, const BuildResult&, Written&) {
  if (command.picture) fmt::print(stderr, "orchard: no picture was made: this program was built without VTK\n");
}
#endif

}  // namespace

void build(const BuildCommand& command) {
  const bool talk = !command.output.quiet && !command.output.json;
  const Stopwatch reading;
  ProgressBar bar(talk);
  const SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  const Surface& surface = solid.surface;
  const double seconds_reading = reading.seconds();
  bar.clear();
  const double wrap_distance = solid.wrap ? solid.wrap->distance() : 0;
  if (talk) print_solid(command.mesh, solid);

  BuildResult result = run_pipeline(surface, command.options, bar.callback());
  result.seconds.insert(result.seconds.begin(), {"reading", seconds_reading});
  bar.clear();

  make_folder(command.folder);
  const Stopwatch writing;
  Written written = write_trees(command, result);
  if (solid.wrap) {
    write_wrap(command, surface.mesh(), written);
  } else {
    fs::remove(wrap_file(command));  // of an earlier run: `verify` would take it for this tree's
  }
  write_views(command, surface, result, written);
  const fs::path plot_file = in_folder(command.folder, command.mesh, "-levels.svg");
  write_file(plot_file, build_plot(result, surface, command.mesh.stem().string()));
  written.emplace_back(plot_file, "this report as a plot");
  result.seconds.emplace_back("writing", writing.seconds());
  nlohmann::json report = build_json(surface, command.options, result, wrap_distance);
  add_solid_json(solid, report);
  const fs::path report_file = in_folder(command.folder, command.mesh, ".json");
  write_file(report_file, report.dump(2) + "\n");
  written.emplace_back(report_file, "this report as JSON");

  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (!talk) return;
  fmt::print("{}: {} triangles, {} clusters, bounding radius {:.6g}\n", command.mesh.string(),
             surface.mesh().triangles.size(), surface.clusters().count(), surface.bounding_radius());
  print_build(result, surface.bounding_radius(), wrap_distance);
  for (const auto& [file, what] : written) fmt::print("  {}  ({})\n", file.string(), what);
}

}  // namespace orchard::apps
