// Options of the commands that make skeletons and parts of medial axes.
#include <fmt/core.h>

#include <optional>

#include "command_line/add_commands.h"
#include "command_line/number_text.h"
#include "command_line/number_validator.h"
#include "command_line/shared_options.h"

namespace orchard::apps {
namespace {

// A measure with the numbers from `low` to `high` as values.
PruneMeasure number_measure(const char* name, const char* help, const char* standard, double low, double high,
                            const std::function<void(double)>& set) {
  const auto fault = [low, high](const std::string& text) -> std::string {
    const std::optional<double> x = finite_number(text);
    if (x && *x >= low && *x <= high) return {};
    return fmt::format("{} is not a number from {:g} to {:g}", text, low, high);
  };
  return {.name = name,
          .help = help,
          .standard = standard,
          .range = fmt::format("{:g} to {:g}", low, high),
          .fault = fault,
          .set = [set](const std::string& text) { set(*finite_number(text)); }};
}

std::vector<PruneMeasure> skeleton_measures(SkeletonOptions& options) {
  return {number_measure("erosion",
                         "Remove curves that reach less than this farther than the sheets beside them are wide, in "
                         "percent of the diagonal",
                         "1", 0, 100, [&options](double x) { options.erosion = x / 100; }),
          number_measure("ratio",
                         "The same as a fraction of how far the curve reaches in all. Higher values remove branches "
                         "into sharper corners",
                         "0.35", 0.2, 0.99, [&options](double x) { options.ratio = x; })};
}

// What both commands have in common: a mesh, its axis and where files go.
void add_axis_options(CLI::App& command, MedialCommand& axis, Request& request, std::vector<PruneMeasure> measures) {
  axis.reading.unite = true;
  add_mesh_options(command, axis.reading);
  add_tuning(command, axis.tuning, false, std::move(measures));
  // These are named like those of the axis' own report, of which nothing is written here.
  command.remove_option(command.get_option("--segment-angle"));
  command.add_option("--axis", axis.axis,
                     "Use this axis of the mesh instead of building one, as orchard medial has written it (.ma, .obj, "
                     ".ply; docs/reference/formats.md). Options that build an axis cannot be given beside it");
  add_report(command, axis.report);
  add_threads(command, request);
  command.add_flag("!--no-views", axis.views, "Do not write files for ParaView");
  add_force(command, axis.output);
  add_output_flags(command, axis.output);
}

}  // namespace

void add_skeleton(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("skeleton", "Reduce the medial axis of a mesh to curves with radii");
  SkeletonCommand& skeleton = request.skeleton;
  add_mesh(command, request, skeleton.axis.mesh, skeleton.axis.reading.input);
  command.add_option("-o,--output", skeleton.axis.folder, "Folder that receives the skeleton and the report")
      ->required();
  add_side(command, skeleton.axis);
  command
      .add_option_function<double>(
          "--skeleton-edge", [&skeleton](double percent) { skeleton.options.edge_length = percent / 100; },
          "Longest edge of the skeleton, in percent of the diagonal [0.75]. Lower values place it more accurately and "
          "take longer")
      ->check(NumberValidator(CLI::Range(0.01, 10.0)));
  command
      .add_option("--straighten", skeleton.options.smoothing,
                  "Rounds in which curves are straightened within the axis. 0 leaves them on edges of its triangles")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  add_axis_options(command, skeleton.axis, request, skeleton_measures(skeleton.options));
  add_accept(command, skeleton.axis.accept);
  command.footer(
      "Examples:\n  orchard skeleton data/faucet.obj -o out/faucet\n"
      "  orchard skeleton data/lamp.obj -o out/lamp --prune erosion=5 --prune ratio=0.5\n"
      "  orchard skeleton data/lamp.obj -o out/lamp --side outside\n"
      "  orchard skeleton data/lamp.obj -o out/lamp --axis out/lamp/lamp.ma");
  command.callback([&request, &command] {
    request.skeleton.axis.output.run = invocation_of(command, request.typed);
    request.skeleton.axis.given = given_of(command);
    // The erosion of curves, not that of axes.
    std::erase(request.skeleton.axis.given, "prune erosion");
    request.run = [&request] { request.exit_code = orchard::apps::skeleton(request.skeleton); };
  });
}

void add_segment(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("segment", "Divide a surface into parts by the sheets and necks of its medial axis");
  SegmentCommand& segment = request.segment;
  add_mesh(command, request, segment.axis.mesh, segment.axis.reading.input);
  command.add_option("-o,--output", segment.axis.folder, "Folder that receives the labelled mesh and the report")
      ->required();
  command
      .add_option_function<std::string>(
          "--by",
          [&segment](const std::string& name) {
            segment.options.kind = name == "sheets"  ? PartKind::sheets
                                   : name == "necks" ? PartKind::necks
                                                     : PartKind::both;
          },
          "What divides the surface: the sheets of the axis (sheets), its necks (necks), or sheets that are cut at "
          "necks (both, default)")
      ->check(CLI::IsMember({"both", "sheets", "necks"}));
  command
      .add_option("--neck", segment.options.neck,
                  "Smallest significance of a neck that cuts: 1 - its radius / the largest radius on its smaller side. "
                  "Lower values cut more")
      ->check(NumberValidator(CLI::Range(0.0, 1.0)))
      ->capture_default_str();
  command
      .add_option_function<double>(
          "--min-area", [&segment](double percent) { segment.options.min_area = percent / 100; },
          "Smallest area of a connected patch, in percent of the surface [0.2]. Smaller ones join a neighbour")
      ->check(NumberValidator(CLI::Range(0.0, 100.0)));
  command
      .add_option("--triangles", segment.options.samples,
                  "Approximate number of triangles into which the surface is divided. Seams run along their edges")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  command
      .add_option(
          "--seam-rounds", segment.options.smoothing,
          "Rounds in which seams are smoothed: a triangle joins the part that it shares most of its border with")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command.add_flag("--meshes", segment.meshes, "Also write each part as a mesh of its own: MODEL-segment-000.ply ..");
  add_axis_options(command, segment.axis, request, {});
  command.footer(
      "Examples:\n  orchard segment data/lamp.obj -o out/lamp\n"
      "  orchard segment data/faucet.obj -o out/faucet --by necks --neck 0.1 --meshes");
  command.callback([&request, &command] {
    request.segment.axis.output.run = invocation_of(command, request.typed);
    request.segment.axis.given = given_of(command);
    request.run = [&request] { request.exit_code = orchard::apps::segment(request.segment); };
  });
}

}  // namespace orchard::apps
