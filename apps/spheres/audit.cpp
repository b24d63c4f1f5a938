#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "input/load_solid.h"
#include "input/reading_report.h"
#include "input/standard_input.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "output/outputs.h"
#include "output/picture.h"
#include "report/report_page.h"
#include "spheres/audit_report.h"
#include "spheres/particle_report.h"
#include "spheres/sphere_files.h"
#include "spheres/sphere_views.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// One set next to the mesh: as it is in the file, or with the buffer that a planner adds to its radii.
struct Audited {
  double buffer = 0;
  std::vector<Sphere> spheres;
  Index switched_off = 0;
  SphereAudit audit;
  std::optional<ParticleFigures> particles;  // where the file has masses, without a buffer
};

// A sphere whose radius a negative buffer reduces to 0 or less counts as switched off.
Audited with_buffer(const SphereGroup& group, double buffer) {
  Audited set{.buffer = buffer, .spheres = {}, .switched_off = group.switched_off, .audit = {}, .particles = {}};
  for (Sphere sphere : group.spheres) {
    sphere.radius += buffer;
    if (sphere.radius > 0)
      set.spheres.push_back(sphere);
    else
      ++set.switched_off;
  }
  return set;
}

void measure_masses(const SphereGroup& group, Audited& set) {
  if (group.masses.empty() || !set.audit.beside_solid) return;
  if (std::all_of(group.masses.begin(), group.masses.end(), [](double mass) { return mass == 0; })) return;
  set.particles = particle_figures(set.spheres, group.masses, set.audit.beside_solid->volume.of_solid, {});
}

// The files to write to the folder.
struct Plan {
  std::optional<Destination> destination;
  Provenance provenance;
};

std::vector<std::string> names_of(const AuditCommand& command) {
  std::vector<std::string> names;
  for (const std::string& ending : sphere_view_endings("-audit")) names.push_back(named(command.mesh, ending));
  names.push_back(named(command.mesh, "-audit.png"));
  names.push_back(page_name(command.mesh, "audit"));
  return names;
}

Plan check(const AuditCommand& command) {
  check_input(command.spheres);
  check_input(command.mesh);
  if (command.folder.empty() && command.picture)
    throw InputError("--picture needs -o FOLDER, where the picture is written to");
  const std::array inputs{command.mesh, command.spheres};
  Plan plan{.destination = {}, .provenance = provenance_of(command.output.run, inputs)};
  if (command.folder.empty()) return plan;
  plan.destination = Destination{.folder = command.folder,
                                 .report = named(command.mesh, "-audit.json"),
                                 .provenance = plan.provenance,
                                 .force = command.output.force};
  check_outputs(*plan.destination, names_of(command), inputs);
  return plan;
}

json audited_json(const Audited& set, const Surface& surface) {
  json report = apps::to_json(set.audit, surface);
  report["buffer"] = set.buffer;
  report["switched_off"] = set.switched_off;
  if (set.particles) {
    json body = apps::to_json(*set.particles, surface.bounding_box().diagonal().norm());
    for (const char* promised : {"wanted_mass", "overlap_proven"}) body.erase(promised);
    report["particles"] = std::move(body);
  }
  return report;
}

void print_set(const Audited& set, const Surface& surface) {
  if (set.buffer != 0) fmt::print("with the buffer of {:g} on every radius:\n", set.buffer);
  if (set.switched_off > 0)
    fmt::print("  {} sphere{} switched off: radius zero or below\n", set.switched_off,
               set.switched_off == 1 ? " is" : "s are");
  print_audit(set.audit, surface);
  if (set.particles) print_bodies(*set.particles, surface.bounding_box().diagonal().norm());
  fmt::print("{}\n", verdict(set.audit, surface));
  if (const std::string frame = suggested_frame(surface, set.spheres); !frame.empty()) fmt::print("{}\n", frame);
}

void write_audit(const AuditCommand& command, const Plan& plan, const Surface& surface, const Audited& set,
                 json& report) {
  if (!plan.destination) return;
  Outputs outputs(*plan.destination);
  write_sphere_views(command.mesh, "-audit", surface, set.spheres, outputs);
  if (command.picture || command.report) draw_holes(command.mesh, command.up, surface, set.spheres, outputs);
  outputs.add_report(report, "this report as JSON");
  if (command.report)
    write_report_page(page_name(command.mesh, "audit"),
                      page_of(report, outputs.take(named(command.mesh, "-audit.png"), command.picture)), outputs);
  outputs.commit();
  if (!command.output.quiet && !command.output.json) outputs.print();
}

}  // namespace

ExitCode audit(const AuditCommand& command) {
  if (lower_extension(command.mesh) == ".urdf") {
    for (const char* option : {"format", "scale", "unit"})
      if (std::find(command.given.begin(), command.given.end(), option) != command.given.end())
        throw InputError(fmt::format("--{} has no effect on a robot: its lengths are metres", option));
    return audit_robot(command);
  }
  for (const char* option : {"package-path", "visual", "ignore-units", "ignore-up", "wrap"})
    if (std::find(command.given.begin(), command.given.end(), option) != command.given.end())
      throw InputError(fmt::format("--{} has no effect on a mesh: it belongs to robots, .urdf", option));
  const Plan plan = check(command);
  const SphereFile file = read_sphere_file(command.spheres);
  const SphereGroup& group = group_named(file, command.spheres, command.link);
  std::vector<Audited> sets{with_buffer(group, 0)};
  const double buffer = command.buffer.value_or(group.buffer);
  if (buffer != 0) sets.push_back(with_buffer(group, buffer));
  for (const Audited& set : sets)
    if (set.spheres.empty())
      throw InputError(fmt::format("{}: all {} spheres are switched off{}: their radii are zero or below",
                                   command.spheres.string(), set.switched_off,
                                   set.buffer != 0 ? " with the buffer" : ""));
  ProgressBar bar(!command.output.quiet && !command.output.json);
  RepairedMesh read = read_repaired(command.mesh, command.input, command.join);
  const Surface surface(std::move(read.mesh));
  for (Audited& set : sets) set.audit = audit_spheres(surface, set.spheres, {}, bar.callback());
  measure_masses(group, sets.front());
  bar.clear();
  print_hole_warning(command.mesh, read.repair, read.distance, surface.bounding_radius());
  json report{{"format", file.format}, {"link", group.name}, {"sets", json::array()}, {"solid", surface.solid()}};
  for (const Audited& set : sets) report["sets"].push_back(audited_json(set, surface));
  report["reading"] = reading_json(read.reading);
  if (read.repair.changed()) report["repair"] = to_json(read.repair, read.distance, surface.bounding_radius());
  report["provenance"] = to_json(plan.provenance);
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (!command.output.json && !command.output.quiet) {
    print_reading(command.mesh, read.reading);
    if (read.repair.changed())
      fmt::print("against the repaired mesh: {}\n", in_words(read.distance, surface.bounding_radius()));
    fmt::print("{}{}: {} spheres ({}) beside {}, diagonal {:.6g}{}\n", command.spheres.string(),
               group.name.empty() ? "" : ", " + group.name, group.spheres.size(), file.format, shown(command.mesh),
               surface.bounding_box().diagonal().norm(), with_unit(read.reading.unit));
    for (const Audited& set : sets) print_set(set, surface);
  }
  write_audit(command, plan, surface, sets.back(), report);
  const bool open =
      std::any_of(sets.begin(), sets.end(), [&](const Audited& set) { return is_open(set.audit, surface); });
  return open ? kAuditOpen : kSucceeded;
}

}  // namespace orchard::apps
