// Options of the commands that make and judge sets of spheres.
#include <fmt/core.h>

#include <numbers>
#include <optional>

#include "command_line/add_commands.h"
#include "command_line/command_list.h"
#include "command_line/list_option.h"
#include "command_line/number_validator.h"
#include "command_line/shared_options.h"
#include "command_line/tree_options.h"
#include "command_line/weight_option.h"
#include "medial/axis_export.h"

namespace orchard::apps {
namespace {

// That say what a set is to be.
void add_set_options(CLI::App& command, SpheresCommand& spheres) {
  SphereSetOptions& options = spheres.options;
  command.add_option("-n,--spheres", options.spheres, "How many: exactly so many, or with an error at most")
      ->check(CLI::Range(1, static_cast<int>(kMaxSetSpheres)))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--fit",
          [&options](const std::string& name) {
            options.fit = name == "inside"      ? SphereFit::inside
                          : name == "balanced"  ? SphereFit::balanced
                          : name == "particles" ? SphereFit::particles
                                                : SphereFit::cover;
          },
          "The promise: cover (hold the whole surface, the default), inside (lie in the solid), balanced (the solid's "
          "volume, and a boundary near its surface) or particles (in the solid, overlaps, mass and inertia as stated)")
      ->check(CLI::IsMember({"cover", "inside", "balanced", "particles"}));
  command
      .add_option(
          "--error", spheres.error,
          "The fewest spheres with this error, in percent of the diagonal: how far a cover sticks out, how far the "
          "surface is from spheres inside or particles, the mean two-sided distance of balanced ones")
      ->check(NumberValidator(CLI::Range(1e-4, 100.0)));
  command
      .add_option("--volume-error", spheres.volume_error,
                  "The same by volume, in percent of the solid's: what of a cover lies outside, what spheres inside or "
                  "particles leave out")
      ->check(NumberValidator(CLI::Range(1e-3, 1000.0)));
  command.add_flag("--solid", options.solid, "A cover of the whole solid, not of its surface alone");
  command
      .add_option("--padding", options.padding,
                  "A cover of every point up to this far from the surface, in mesh units: added to all radii")
      ->check(NumberValidator(CLI::Range(0.0, 1e15)))
      ->capture_default_str();
  command.add_option("--min-radius", options.min_radius, "No sphere is smaller, in mesh units")
      ->check(NumberValidator(CLI::Range(0.0, 1e15)))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--effort",
          [&options](const std::string& name) {
            options.effort = name == "low" ? Effort::low : name == "high" ? Effort::high : Effort::standard;
          },
          "How long to search: low, standard (default) or high")
      ->check(CLI::IsMember({"low", "standard", "high"}));
  command.add_option("--seed", options.seed, "Of all random choices")->capture_default_str();
  add_list(command, "--curve", spheres.curve,
           "Make sets of these numbers of spheres as well, and write how far off each is: MODEL-set-curve.csv and .svg",
           1, kMaxSetSpheres);
}

// That say which part of the mesh counts, and where it counts more.
void add_place_options(CLI::App& command, SpheresCommand& spheres) {
  command
      .add_option("--clip", spheres.clip,
                  "Only the part of the solid where NX x + NY y + NZ z is D or more, closed where the plane cuts it: "
                  "NX NY NZ D")
      ->expected(4);
  SetWeights& weights = spheres.options.weights;
  command
      .add_option_function<std::vector<std::string>>(
          "--weight",
          [&weights](const std::vector<std::string>& regions) {
            for (const std::string& region : regions) weights.regions.push_back(parse_weight(region));
          },
          "Where looseness counts F times: x,y,z,r=F in a ball, x,y,z,x,y,z=F in a box; may be repeated")
      ->allow_extra_args(false);
  command.add_option("--vertex-weights", spheres.vertex_weights,
                     "The same for what is near each vertex: a file of a number a line, in the mesh's order");
}

// For `--fit particles` alone.
void add_particle_options(CLI::App& command, SpheresCommand& spheres) {
  ParticleOptions& options = spheres.options.particles;
  command
      .add_option("--overlap", spheres.overlap,
                  "Particles: how much of the smaller of two spheres may lie in the other, in percent of its volume")
      ->check(NumberValidator(CLI::Range(0.0, 100.0)))
      ->capture_default_str();
  command.add_flag("--equal", options.equal_radii, "Particles: all radii are equal");
  command.add_option("--density", options.density, "Particles: mass over volume, in any unit")
      ->check(NumberValidator(CLI::Range(1e-15, 1e15)))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--density-of",
          [&options](const std::string& name) {
            options.density_of =
                name == "balls" ? ParticleOptions::DensityOf::balls : ParticleOptions::DensityOf::solid;
          },
          "Particles: the density is that of the solid, whose mass the spheres share (solid, the default), or of each "
          "sphere (balls)")
      ->check(CLI::IsMember({"solid", "balls"}));
  command.add_flag("--masses", options.own_masses,
                   "Particles: each has a mass of its own, so that centre of mass and inertia are the solid's");
  command
      .add_option("--center-error", spheres.center_error,
                  "Particles: how far off the centre of mass may be, in percent of the diagonal")
      ->check(NumberValidator(CLI::Range(1e-6, 100.0)))
      ->capture_default_str();
  command
      .add_option("--inertia-error", spheres.inertia_error,
                  "Particles: how far off the inertia tensor may be at equal mass, in percent")
      ->check(NumberValidator(CLI::Range(1e-6, 1000.0)))
      ->capture_default_str();
}

}  // namespace

void add_spheres(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("spheres", "Make a set of spheres for a mesh, with a promise and its proof");
  SpheresCommand& spheres = request.spheres;
  command
      .add_option(
          "mesh", spheres.mesh,
          "The mesh; or spheres that are there already, as audit reads them, to be written in other formats and "
          "as a tree")
      ->required();
  command.add_option("-o,--output", spheres.folder, "Folder for the spheres, the views and the report")->required();
  add_set_options(command, spheres);
  add_place_options(command, spheres);
  add_particle_options(command, spheres);
  add_mesh_options(command, spheres.reading);
  add_list(command, "--export", spheres.exports,
           "The spheres in further formats: json, csv, urdf (a link's collision geometry), yaml (cuRobo's)",
           {"json", "csv", "urdf", "yaml"});
  command.add_option(
      "--link", spheres.link,
      "The link's name in urdf and yaml (default: the mesh's); of a file of spheres for several, which one");
  command.add_flag(
      "--tree", spheres.tree,
      "Write an .orchard file over the spheres, for the run-time: of a cover it holds the surface, otherwise "
      "the union of the spheres is the object");
  command.add_flag("!--no-views", spheres.views, "Write no files for ParaView");
  command.add_flag("--picture", spheres.picture, "Draw the spheres");
  add_up(command, spheres.up);
  add_threads(command, request);
  add_accept(command, spheres.accept);
  add_force(command, spheres.output);
  add_output_flags(command, spheres.output);
  command.footer(
      "Examples:\n  orchard spheres data/lamp.obj -o out/lamp-spheres -n 20\n"
      "  orchard spheres data/lamp.obj -o out/lamp-inside -n 40 --fit inside --export json,csv\n"
      "  orchard spheres data/lamp.obj -o out/lamp-balanced -n 30 --fit balanced\n"
      "  orchard spheres data/lamp.obj -o out/lamp-particles -n 200 --fit particles --equal\n"
      "  orchard spheres out/lamp-spheres/lamp-set.txt -o out/lamp-union --tree");
  command.callback([&request, &command] {
    request.spheres.output.run = invocation_of(command, request.typed);
    request.spheres.given = given_of(command);
    request.run = [&request] { request.exit_code = orchard::apps::spheres(request.spheres); };
  });
}

void add_audit(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("audit", "Prove what a set of spheres of any origin leaves open of a mesh, and measure it");
  AuditCommand& audit = request.audit;
  command
      .add_option(
          "spheres", audit.spheres,
          "The spheres, in the mesh's frame: text or .csv of x y z r, .json lists, .yml of cuRobo, .xrdf, .urdf, "
          ".srdf, .xml (MJCF), .mol (LAMMPS), .py (YADE), .ply with radii, .sph, .orchard; of a robot also a folder of "
          "MorphIt's files")
      ->required();
  command
      .add_option("mesh", audit.mesh,
                  "The mesh: .obj, .ply, .stl or .off; or a robot's .urdf, with all of whose links the spheres are "
                  "compared")
      ->required();
  command.add_option("--link", audit.link, "The link, where a file has several");
  command
      .add_option("--buffer", audit.buffer,
                  "Audit the spheres with this much on every radius, too, in place of the file's own buffer")
      ->check(NumberValidator(CLI::Range(-1e15, 1e15)));
  add_join(command, audit.join);
  add_robot_reading(command, audit.reading);
  command.add_flag("--wrap", audit.wrap,
                   "Of a robot: links that are no solids are compared as closed skins around them, otherwise by their "
                   "surface alone");
  auto* folder = command.add_option("-o,--output", audit.folder, "Folder for the views and the report");
  auto* picture =
      command.add_flag("--picture", audit.picture, "Draw where the surface is open and where spheres stick out")
          ->needs(folder);
  add_up(command, audit.up)->needs(picture);
  add_force(command, audit.output)->needs(folder);
  add_output_flags(command, audit.output);
  command.footer(
      "Exit code 3 if some of the surface is open.\n"
      "Examples:\n  orchard audit out/lamp-spheres/lamp-set.txt data/lamp.obj -o out/lamp-audit\n"
      "  orchard audit out/desk-arm/desk-arm-curobo.yml data/desk-arm.urdf");
  command.callback([&request, &command] {
    request.audit.output.run = invocation_of(command, request.typed);
    request.audit.given = given_of(command);
    request.run = [&request] { request.exit_code = orchard::apps::audit(request.audit); };
  });
}

}  // namespace orchard::apps
