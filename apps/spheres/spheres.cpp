#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "command_line/text.h"
#include "command_line/weight_option.h"
#include "input/input_file.h"
#include "input/load_solid.h"
#include "input/reading_report.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/clip.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "output/json_values.h"
#include "output/outputs.h"
#include "output/report.h"
#include "report/report_page.h"
#include "spheres/audit_report.h"
#include "spheres/particle_report.h"
#include "spheres/set_files.h"
#include "spheres/sphere_views.h"
#include "spheres/spheres_output.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double kPercent = 0.01;

SphereSetOptions options_of(const SpheresCommand& command) {
  SphereSetOptions options = command.options;
  options.error = kPercent * command.error;
  options.volume_error = kPercent * command.volume_error;
  options.particles.overlap = kPercent * command.overlap;
  options.particles.center_error = kPercent * command.center_error;
  options.particles.inertia_error = kPercent * command.inertia_error;
  if ((options.error > 0 || options.volume_error > 0) && !among("spheres", command.given))
    options.spheres = kMaxSetSpheres;
  return options;
}

// The part on one side of the plane takes the solid's place.
void clip(const SpheresCommand& command, SolidMesh& solid) {
  if (command.clip.empty()) return;
  const HalfSpace kept{Vector(command.clip[0], command.clip[1], command.clip[2]), command.clip[3]};
  try {
    solid.surface = Surface(clip_solid(solid.surface.mesh(), kept), command.reading.ball);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: --clip: {}", command.mesh.string(), error.what()));
  }
}

// What can be refused before anything is built; then where the files go.
Destination check(const SpheresCommand& command) {
  check_input(command.mesh);
  check_options(command);
  std::vector<fs::path> inputs{command.mesh};
  if (!command.vertex_weights.empty()) {
    check_input(command.vertex_weights);
    inputs.push_back(command.vertex_weights);
  }
  Destination destination{.folder = command.folder,
                          .report = named(command.mesh, "-set.json"),
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  keep_single_file(destination, set_files(command));
  check_outputs(destination, set_file_names(command), inputs);
  return destination;
}

void write_tree(const SpheresCommand& command, const Surface& surface, const SphereSetBuild& set, Outputs& outputs) {
  if (!command.tree) return;
  if (set.fit == SphereFit::cover && set.audit.covered)
    write_cover_tree(command, surface, set.spheres, outputs);
  else
    write_union_tree(command, set.spheres, outputs);
}

void write_error_curve(const SpheresCommand& command, const Surface& surface, const std::vector<SphereSetBuild>& sets,
                       Outputs& outputs) {
  if (command.error_curve.empty()) return;
  const double diagonal = surface.bounding_box().diagonal().norm();
  write_file(outputs.add(named(command.mesh, "-set-error-curve.csv"), "number of spheres and errors"),
             error_curve_csv(sets, diagonal));
  write_file(outputs.add(named(command.mesh, "-set-error-curve.svg"), "the same as a plot"),
             plot::to_svg(error_curve_plots(sets, diagonal, command.mesh.stem().string()), 2));
}

// The set itself, and those of the error curve in the order of their numbers.
std::vector<SphereSetBuild> build_sets(const SpheresCommand& command, const Surface& surface,
                                       const SphereSetOptions& options, const Progress& progress, std::size_t& chosen) {
  std::vector<Index> numbers = command.error_curve;
  numbers.push_back(options.spheres);
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<SphereSetBuild> sets;
  for (const Index number : numbers) {
    if (number == options.spheres) chosen = sets.size();
    SphereSetOptions own = options;
    own.spheres = number;
    own.find_enough = options.find_enough && number == options.spheres;
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
  report["enough_spheres"] = broken.none() ? json(set.spheres.size()) : set.enough ? json(*set.enough) : json();
  if (set.particles) report["particles"] = to_json(*set.particles, solid.surface.bounding_box().diagonal().norm());
  report["seconds"] = seconds_json(set.seconds);
  add_solid_json(solid, report);
  report["mesh"] = mesh_json(solid.surface);
  report["certified_mesh"] = !command.clip.empty() ? json(named(command.mesh, kClippedEnding))
                             : solid.wrap          ? json(named(command.mesh, kWrapEnding))
                             : solid.changed()     ? json(named(command.mesh, kRepairedEnding))
                                                   : json();
  return report;
}

}  // namespace

void check_options(const SpheresCommand& command) {
  const SphereSetOptions options = options_of(command);
  require_usable(options);
  for (const char* option : {"overlap", "equal", "density", "density-of", "masses", "center-error", "inertia-error"})
    if (options.fit != SphereFit::particles && among(option, command.given))
      throw InputError(fmt::format("--{} has no effect without --fit particles", option));
  if (!command.vertex_weights.empty() && !command.clip.empty())
    throw InputError("--vertex-weights has no effect with --clip, which changes the vertices: give --weight");
  const bool by_error = options.error > 0 || options.volume_error > 0;
  if (by_error && !command.error_curve.empty())
    throw InputError("--error-curve has no effect with --error or --volume-error, which choose the number of spheres");
}

ExitCode spheres(const SpheresCommand& command) {
  if (names_spheres(command.mesh)) return spheres_of_file(command);
  const Destination destination = check(command);
  SphereSetOptions options = options_of(command);
  const bool talk = !command.output.quiet && !command.output.json;
  ProgressBar bar(talk);
  SolidMesh solid = load_solid(command.mesh, command.reading, bar.callback());
  clip(command, solid);
  if (!command.vertex_weights.empty()) options.weights.of_vertices = read_vertex_weights(command.vertex_weights);
  const Surface& surface = solid.surface;
  bar.clear();
  if (talk) print_solid(command.mesh, solid);
  print_hole_warning(command.mesh, solid.repair, solid.repair_distance, surface.bounding_radius());
  std::size_t chosen = 0;
  const std::vector<SphereSetBuild> sets = build_sets(command, surface, options, bar.callback(), chosen);
  bar.clear();
  const SphereSetBuild& set = sets[chosen];
  const double diagonal = surface.bounding_box().diagonal().norm();
  const Broken broken = apps::broken(options, set, diagonal);
  json report = report_of(command, solid, options, set, broken);
  if (!command.error_curve.empty()) report["error_curve"] = error_curve_json(sets, diagonal);

  Outputs outputs(destination);
  const std::string promise = broken.none()
                                  ? promise_in_words(options, set)
                                  : fmt::format("THE BEST FOUND, NOT AS ASKED FOR: {}", fmt::join(broken.what, "; "));
  write_set(command, destination.provenance,
            {.spheres = set.spheres,
             .title = fmt::format("{}: {}", name(set.fit), promise),
             .particles = set.particles ? &*set.particles : nullptr},
            outputs);
  write_tree(command, surface, set, outputs);
  write_error_curve(command, surface, sets, outputs);
  if (command.views) write_sphere_views(command.mesh, "-set", surface, set.spheres, outputs);
  const std::string picture = named(command.mesh, "-set.png");
  if (command.picture || command.report)
    draw_spheres(picture, command.mesh.stem().string(), command.up, surface, set.spheres, outputs);
  if (!report["certified_mesh"].is_null())
    write_obj(outputs.add(report["certified_mesh"], "the mesh that the promise is about"), surface.mesh());
  outputs.add_report(report, "this report as JSON");
  if (command.report)
    write_report_page(page_name(command.mesh, "spheres"), page_of(report, outputs.take(picture, command.picture)),
                      outputs);
  outputs.commit();

  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (talk) {
    fmt::print("{}: {} spheres, fit {}, {:.2f} s\n", command.mesh.string(), set.spheres.size(), name(set.fit),
               set.seconds.front().second);
    print_audit(set.audit, surface);
    if (set.particles) print_particles(*set.particles, diagonal);
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
