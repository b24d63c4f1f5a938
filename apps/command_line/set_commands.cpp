// Options of the commands that make and audit sets of spheres.
#include <fmt/core.h>

#include <array>
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
#include "output/outputs.h"

namespace orchard::apps {
namespace {

// Options for the spheres of a set.
void add_set_options(CLI::App& command, SpheresCommand& spheres) {
  SphereSetOptions& options = spheres.options;
  command
      .add_option("-n,--spheres", options.spheres,
                  "Number of spheres: exactly this many, or at most with --error or --volume-error")
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
          "What the set promises: cover (default; the spheres contain the whole surface), inside (they lie in the "
          "solid), balanced (their union has the solid's volume and a boundary near its surface) or particles (they "
          "lie in the solid with the stated overlap, mass and inertia)")
      ->check(CLI::IsMember({"cover", "inside", "balanced", "particles"}));
  command
      .add_option(
          "--error", spheres.error,
          "Use the fewest spheres within this error, in percent of the diagonal: how far a cover protrudes, how far "
          "the surface is from spheres inside or particles, the mean two-sided distance of a balanced set")
      ->check(NumberValidator(CLI::Range(1e-4, 100.0)));
  command
      .add_option("--volume-error", spheres.volume_error,
                  "Use the fewest spheres within this error of volume, in percent of the solid's: the part of a cover "
                  "outside, or the part of the solid that spheres inside or particles leave out")
      ->check(NumberValidator(CLI::Range(1e-3, 1000.0)));
  command.add_flag("--solid", options.solid, "Cover the whole solid, not only its surface");
  command
      .add_option("--padding", options.padding,
                  "Cover every point up to this distance from the surface, in mesh units, by adding it to all radii")
      ->check(NumberValidator(CLI::Range(0.0, 1e15)))
      ->capture_default_str();
  command.add_option("--min-radius", options.min_radius, "Smallest radius, in mesh units")
      ->check(NumberValidator(CLI::Range(0.0, 1e15)))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--effort",
          [&options](const std::string& name) {
            options.effort = name == "low" ? Effort::low : name == "high" ? Effort::high : Effort::standard;
          },
          "How long to search (default: standard). high takes about three times as long and gives slightly tighter "
          "sets")
      ->check(CLI::IsMember({"low", "standard", "high"}));
  command.add_option("--seed", options.seed, "Seed of all random choices")->capture_default_str();
  add_list(command, "--error-curve", spheres.error_curve,
           "Also fit sets of these numbers of spheres and write the error of each: MODEL-set-error-curve.csv and .svg",
           1, kMaxSetSpheres);
}

// Options for the part of the mesh that counts, and for the weights of its parts.
void add_place_options(CLI::App& command, SpheresCommand& spheres) {
  command
      .add_option("--clip", spheres.clip,
                  "NX NY NZ D: fit only the part of the solid where NX x + NY y + NZ z is at least D. The cut is "
                  "closed by a flat cap")
      ->expected(4);
  SetWeights& weights = spheres.options.weights;
  command
      .add_option_function<std::vector<std::string>>(
          "--weight",
          [&weights](const std::vector<std::string>& regions) {
            for (const std::string& region : regions) weights.regions.push_back(parse_weight(region));
          },
          "Count looseness F times in a ball, x,y,z,r=F, or in a box between two corners, x,y,z,x,y,z=F. May be "
          "repeated")
      ->allow_extra_args(false);
  command.add_option(
      "--vertex-weights", spheres.vertex_weights,
      "File of weights of looseness near the vertices: one number in each line, in the order of the mesh");
}

// Options that only `--fit particles` uses.
void add_particle_options(CLI::App& command, SpheresCommand& spheres) {
  ParticleOptions& options = spheres.options.particles;
  command
      .add_option("--overlap", spheres.overlap,
                  "particles: largest share of the smaller of two spheres that lies in the other, in percent of its "
                  "volume. 0 allows none")
      ->check(NumberValidator(CLI::Range(0.0, 100.0)))
      ->capture_default_str();
  command.add_flag("--equal", options.equal_radii, "particles: make all radii equal");
  command.add_option("--density", options.density, "particles: mass per volume, in any unit")
      ->check(NumberValidator(CLI::Range(1e-15, 1e15)))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--density-of",
          [&options](const std::string& name) {
            options.density_of =
                name == "balls" ? ParticleOptions::DensityOf::balls : ParticleOptions::DensityOf::solid;
          },
          "particles: what --density refers to: the solid, whose mass the spheres share (solid, default), or each "
          "sphere "
          "(balls)")
      ->check(CLI::IsMember({"solid", "balls"}));
  command.add_flag(
      "--masses", options.own_masses,
      "particles: give each sphere a mass of its own, so that centre of mass and inertia are those of the solid");
  command
      .add_option("--center-error", spheres.center_error,
                  "particles: largest error of the centre of mass, in percent of the diagonal")
      ->check(NumberValidator(CLI::Range(1e-6, 100.0)))
      ->capture_default_str();
  command
      .add_option("--inertia-error", spheres.inertia_error,
                  "particles: largest error of the inertia tensor at equal mass, in percent")
      ->check(NumberValidator(CLI::Range(1e-6, 1000.0)))
      ->capture_default_str();
}

}  // namespace

void add_spheres(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("spheres", "Fit a set of spheres to a mesh and prove what the set promises");
  SpheresCommand& spheres = request.spheres;
  command
      .add_option(
          "mesh", spheres.mesh,
          mesh_help("Sphere set that audit reads, to convert it to other formats or to a tree, or a mesh to fit"))
      ->required();
  command
      .add_option("-o,--output", spheres.folder,
                  "Folder that receives the spheres, the views and the report, or a file for the spheres alone (.txt, "
                  ".csv, .json, .yml, .urdf or .orchard)")
      ->required();
  add_set_options(command, spheres);
  add_place_options(command, spheres);
  add_particle_options(command, spheres);
  request.meshes.push_back({&spheres.mesh, &spheres.reading.input});
  add_mesh_input(command, spheres.reading.input);
  add_mesh_options(command, spheres.reading);
  add_list(
      command, "--export", spheres.exports,
      "Also write the spheres as json, csv, npz (for NumPy), urdf (collision geometry of a link) or yaml (cuRobo's "
      "format)",
      {"json", "csv", "npz", "urdf", "yaml"});
  command.add_option(
      "--link", spheres.link,
      "Name of the link in urdf and yaml (default: that of the mesh), or the link to read from a file of several");
  command.add_flag(
      "--tree", spheres.tree,
      "Also write a sphere-tree (.orchard) of the spheres, for the run-time. For a cover, its object is the "
      "surface; for other sets, the union of the spheres");
  command.add_flag("!--no-views", spheres.views, "Do not write files for ParaView");
  command.add_flag("--picture", spheres.picture, "Also draw the spheres to a .png file");
  add_report(command, spheres.report);
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
    export_single_file(request.spheres.folder, {"json", "csv", "urdf", "yaml"}, request.spheres.exports);
    request.spheres.tree |= !file_ending(request.spheres.folder, std::array<std::string, 1>{".orchard"}).empty();
    request.run = [&request] { request.exit_code = orchard::apps::spheres(request.spheres); };
  });
}

void add_audit(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("audit", "Measure any set of spheres against a mesh and prove what it leaves open");
  AuditCommand& audit = request.audit;
  command
      .add_option("spheres", audit.spheres,
                  "Sphere set in the mesh's frame: text or .csv of x y z r, .json lists, .yml of cuRobo, .xrdf, .urdf, "
                  ".srdf, .xml (MJCF), .mol (LAMMPS), .py (YADE), .ply with radii, .sph or .orchard. For a robot, also "
                  "a folder of MorphIt's files")
      ->required();
  command
      .add_option("mesh", audit.mesh,
                  mesh_help("The .urdf of a robot, to audit the spheres of all its links, or a mesh"))
      ->required();
  request.meshes.push_back({&audit.mesh, &audit.input});
  add_mesh_input(command, audit.input);
  command.add_option("--link", audit.link, "Link to audit, if the file has several");
  command
      .add_option("--buffer", audit.buffer,
                  "Also audit the spheres with this added to every radius, in place of the buffer that the file states")
      ->check(NumberValidator(CLI::Range(-1e15, 1e15)));
  add_join(command, audit.join);
  add_robot_reading(command, audit.reading);
  command.add_flag("--wrap", audit.wrap,
                   "Robots: wrap links that are not solids in closed skins, instead of measuring only their surface");
  auto* folder = command.add_option("-o,--output", audit.folder, "Folder that receives the views and the report");
  auto* picture =
      command.add_flag("--picture", audit.picture, "Draw where the surface is open and where spheres protrude")
          ->needs(folder);
  add_report(command, audit.report)->needs(folder);
  add_up(command, audit.up)->needs(picture);
  add_force(command, audit.output)->needs(folder);
  add_output_flags(command, audit.output);
  command.footer(
      "The exit code is 3 if some of the surface is open.\n"
      "Examples:\n  orchard audit out/lamp-spheres/lamp-set.txt data/lamp.obj\n"
      "  orchard audit out/lamp-spheres/lamp-set.txt data/lamp.obj -o out/lamp-audit --picture\n"
      "  orchard audit robot.yml link.stl --link forearm --buffer 0.01\n"
      "  orchard audit out/desk-arm/desk-arm-curobo.yml data/desk-arm.urdf");
  command.callback([&request, &command] {
    request.audit.output.run = invocation_of(command, request.typed);
    request.audit.given = given_of(command);
    request.run = [&request] { request.exit_code = orchard::apps::audit(request.audit); };
  });
}

}  // namespace orchard::apps
