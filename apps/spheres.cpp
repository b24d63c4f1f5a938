#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "audit_report.h"
#include "commands.h"
#include "console.h"
#include "input_file.h"
#include "load_solid.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/proven.h"
#include "outputs.h"
#include "picture.h"
#include "reading_report.h"
#include "sphere_views.h"
#include "spheres_output.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double kPercent = 0.01;

bool among(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

SphereSetOptions options_of(const SpheresCommand& command) {
  SphereSetOptions options = command.options;
  options.error = kPercent * command.error;
  options.volume_error = kPercent * command.volume_error;
  if ((options.error > 0 || options.volume_error > 0) && !among("spheres", command.given))
    options.spheres = kMaxSetSpheres;
  return options;
}

std::vector<std::string> names_of(const SpheresCommand& command) {
  std::vector<std::string> endings = sphere_view_endings("-set");
  for (const char* ending : {"-set.txt", "-set.csv", "-set-spheres.json", "-set.yml", "-set.urdf", "-set.orchard",
                             "-set.png", "-set-curve.csv", "-set-curve.svg"})
    endings.emplace_back(ending);
  endings.emplace_back(command.reading.wrap.empty() ? kRepairedEnding : kWrapEnding);
  std::vector<std::string> names;
  for (const std::string& ending : endings) names.push_back(named(command.mesh, ending));
  return names;
}

// What can be refused before anything is built; then where the files go.
Destination check(const SpheresCommand& command) {
  check_input(command.mesh);
  const SphereSetOptions options = options_of(command);
  require_usable(options);
  if (command.tree && options.fit != SphereFit::cover)
    throw InputError("--tree needs --fit cover: a tree answers for a surface that its spheres hold");
  if (command.tree && options.spheres > kMaxBranching)
    throw InputError(fmt::format("--tree takes at most {} spheres: give -n", kMaxBranching));
  const bool by_error = options.error > 0 || options.volume_error > 0;
  if (by_error && !command.curve.empty())
    throw InputError("--curve has no effect with --error or --volume-error, which choose the number of spheres");
  const std::vector<fs::path> inputs{command.mesh};
  Destination destination{.folder = command.folder,
                          .report = named(command.mesh, "-set.json"),
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  check_outputs(destination, names_of(command), inputs);
  return destination;
}

std::string link_of(const SpheresCommand& command) {
  return command.link.empty() ? command.mesh.stem().string() : command.link;
}

void write_spheres(const SpheresCommand& command, const SphereSetOptions& options, const Provenance& provenance,
                   const SphereSetBuild& set, Outputs& outputs) {
  const auto write = [&](const char* ending, std::string_view bytes, const char* what) {
    write_file(outputs.add(named(command.mesh, ending), what), bytes);
  };
  write("-set.txt",
        to_text(set.spheres, {fmt::format("x y z r of {} spheres; {}: {}", set.spheres.size(), name(set.fit),
                                          set.kept ? promise_in_words(options, set) : "NOT PROVEN"),
                              line_of(provenance)}),
        "the spheres as text, x y z r");
  for (const std::string& format : command.exports) {
    if (format == "csv") write("-set.csv", to_csv(set.spheres), "the same as a table");
    if (format == "yaml") write("-set.yml", to_yaml(set.spheres, link_of(command)), "the same as cuRobo reads it");
    if (format == "urdf")
      write("-set.urdf", set_as_urdf(set.spheres, link_of(command)), "the same as a link's collision geometry");
    if (format != "json") continue;
    json spheres = to_json(set.spheres);
    spheres["provenance"] = decisive_json(provenance);
    write("-set-spheres.json", spheres.dump(1) + "\n", "the same as lists of centres and radii");
  }
}

void write_tree(const SpheresCommand& command, const Surface& surface, const SphereSetBuild& set, Outputs& outputs) {
  if (!command.tree) return;
  SphereTree tree = tree_over(set.spheres, surface.bounding_ball());
  measure(tree, surface);
  const ProvenTree proven = pack_proven(tree, surface);
  if (!proven.proof.ok()) throw Error("the tree over the spheres is not proven to hold the surface");
  const auto bytes = runtime::serialize(proven.packed);
  write_file(outputs.add(named(command.mesh, "-set.orchard"), "a tree of two levels over them, for the run-time"),
             std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

#ifdef ORCHARD_HAS_VIZ
void draw(const SpheresCommand& command, const Surface& surface, const SphereSetBuild& set, Outputs& outputs) {
  if (!command.picture) return;
  const SphereTree tree = tree_over(set.spheres, surface.bounding_ball());
  PipelinePicture picture;
  picture.values.surface = &surface;
  picture.values.tree = &tree;
  picture.title = command.mesh.stem().string();
  picture.up = parse_up(command.up);
  picture.progress = cancelled_by_interrupts();
  const std::string file = named(command.mesh, "-set.png");
  if (is_drawn(draw_pipeline(outputs.staged(file), picture)))
    outputs.add(file, "the mesh and the spheres as a picture");
}
#else
void draw(const SpheresCommand& command, const Surface&, const SphereSetBuild&, Outputs&) {
  if (command.picture) fmt::print(stderr, "orchard: no picture was made: this program was built without VTK\n");
}
#endif

void write_curve(const SpheresCommand& command, const Surface& surface, const std::vector<SphereSetBuild>& sets,
                 Outputs& outputs) {
  if (command.curve.empty()) return;
  const double diagonal = surface.bounding_box().diagonal().norm();
  write_file(outputs.add(named(command.mesh, "-set-curve.csv"), "number of spheres and errors"),
             curve_csv(sets, diagonal));
  write_file(outputs.add(named(command.mesh, "-set-curve.svg"), "the same as a plot"),
             plot::to_svg(curve_plots(sets, diagonal, command.mesh.stem().string()), 2));
}

// The set itself, and those of the curve in the order of their numbers.
std::vector<SphereSetBuild> build_sets(const SpheresCommand& command, const Surface& surface,
                                       const SphereSetOptions& options, const Progress& progress, std::size_t& chosen) {
  std::vector<Index> numbers = command.curve;
  numbers.push_back(options.spheres);
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<SphereSetBuild> sets;
  for (const Index number : numbers) {
    if (number == options.spheres) chosen = sets.size();
    SphereSetOptions own = options;
    own.spheres = number;
    sets.push_back(build_sphere_set(surface, own, progress));
  }
  return sets;
}

json report_of(const SpheresCommand& command, const SolidMesh& solid, const SphereSetOptions& options,
               const SphereSetBuild& set, const Broken& broken) {
  json report = to_json(set.audit, solid.surface);
  report["fit"] = name(set.fit);
  report["spheres"] = set.spheres.size();
  report["padding"] = options.padding;
  report["promise"] = {{"text", promise_in_words(options, set)}, {"kept", broken.none()}, {"broken", broken.what}};
  for (const auto& [stage, seconds] : set.seconds) report["seconds"][stage] = seconds;
  add_solid_json(solid, report);
  report["certified_mesh"] = solid.wrap               ? json(named(command.mesh, kWrapEnding))
                             : solid.repair.changed() ? json(named(command.mesh, kRepairedEnding))
                                                      : json();
  return report;
}

}  // namespace

ExitCode spheres(const SpheresCommand& command) {
  const Destination destination = check(command);
  const SphereSetOptions options = options_of(command);
  const bool talk = !command.output.quiet && !command.output.json;
  ProgressBar bar(talk);
  const SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  const Surface& surface = solid.surface;
  bar.clear();
  if (talk) print_solid(command.mesh, solid);
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, surface.bounding_radius());
  std::size_t chosen = 0;
  const std::vector<SphereSetBuild> sets = build_sets(command, surface, options, bar.callback(), chosen);
  bar.clear();
  const SphereSetBuild& set = sets[chosen];
  const Broken broken = apps::broken(options, set);
  json report = report_of(command, solid, options, set, broken);

  Outputs outputs(destination);
  write_spheres(command, options, destination.provenance, set, outputs);
  write_tree(command, surface, set, outputs);
  write_curve(command, surface, sets, outputs);
  if (command.views) write_sphere_views(command.mesh, "-set", surface, set.spheres, outputs);
  draw(command, surface, set, outputs);
  if (!report["certified_mesh"].is_null())
    write_obj(outputs.add(report["certified_mesh"], "the mesh that the promise is about"), surface.mesh());
  outputs.add_report(report, "this report as JSON");
  outputs.commit();

  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (talk) {
    fmt::print("{}: {} spheres, fit {}, {:.2f} s\n", command.mesh.string(), set.spheres.size(), name(set.fit),
               set.seconds.front().second);
    print_audit(set.audit, surface);
    outputs.print();
    if (set.kept)
      fmt::print("PROMISED: {}; {}\n", promise_in_words(options, set),
                 set.fit == SphereFit::balanced ? "measured" : "proven");
    if (options.padding > 0) fmt::print("The figures are those without the padding.\n");
  }
  if (!broken.none()) fmt::print(stderr, "orchard: {}: {}\n", command.mesh.string(), in_one_line(broken));
  return exit_code(broken, command.accept);
}

}  // namespace orchard::apps
