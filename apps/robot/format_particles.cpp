// Links as rigid particles: LIGGGHTS, LAMMPS and YADE.
#include <fmt/format.h>

#include <cctype>
#include <numbers>

#include "robot/format_text.h"

namespace orchard::robot {
namespace {

constexpr Index kTries = 1'000'000;  // of LIGGGHTS' own Monte Carlo integration

// A name of letters, digits and underscores, as identifiers are.
std::string identifier(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0) name.insert(name.begin(), '_');
  return name;
}

bool is_prime(Index number) {
  for (Index divisor = 2; divisor * divisor <= number; ++divisor)
    if (number % divisor == 0) return false;
  return true;
}

Index next_prime(Index number) {
  while (!is_prime(++number)) {
  }
  return number;
}

double volume(const Sphere& sphere) { return 4 * std::numbers::pi / 3 * std::pow(sphere.radius, 3); }

std::string lines_of(const std::vector<Sphere>& spheres) {
  std::string text;
  for (const Sphere& sphere : spheres) text += point_text(sphere.center, " ") + " " + float_text(sphere.radius) + "\n";
  return text;
}

std::string molecule(const SphereModel& model, std::size_t g) {
  const std::vector<Sphere>& spheres = model.groups[g].spheres;
  const Inertial& body = model.bodies[g];
  const Eigen::Matrix3d& i = body.inertia;
  double sum = 0;
  for (const Sphere& sphere : spheres) sum += volume(sphere);
  std::string text = fmt::format("# {}, link {}: {}\n\n{} atoms\n", model.robot->name, model.groups[g].name,
                                 model.head.empty() ? "" : model.head.front(), spheres.size());
  text += fmt::format("{} mass\n{} com\n{} {} inertia\n", float_text(body.mass), point_text(body.center, " "),
                      point_text(i.diagonal(), " "), point_text(Point(i(0, 1), i(0, 2), i(1, 2)), " "));
  std::string coords = "\nCoords\n\n", types = "\nTypes\n\n", diameters = "\nDiameters\n\n", masses = "\nMasses\n\n";
  for (std::size_t s = 0; s < spheres.size(); ++s) {
    coords += fmt::format("{} {}\n", s + 1, point_text(spheres[s].center, " "));
    types += fmt::format("{} 1\n", s + 1);
    diameters += fmt::format("{} {}\n", s + 1, float_text(2 * spheres[s].radius));
    masses += fmt::format("{} {}\n", s + 1, float_text(body.mass * volume(spheres[s]) / sum));
  }
  return text + coords + types + diameters + masses;
}

std::string single_template(const std::string& name, Index seed, const Sphere& sphere, const Inertial& body) {
  return fmt::format(
      "fix {} all particletemplate/sphere {} atom_type 1 volume_limit 1e-16 density constant {} radius constant {}\n",
      name, seed, float_text(body.mass / volume(sphere)), float_text(sphere.radius));
}

std::string template_of(const std::string& name, Index seed, const std::vector<Sphere>& spheres, const Inertial& body,
                        const std::string& file, Index type) {
  const Eigen::Matrix3d& i = body.inertia;
  double sum = 0;
  for (const Sphere& sphere : spheres) sum += volume(sphere);
  return fmt::format(
      "fix {} all particletemplate/multisphere {} atom_type 1 volume_limit 1e-16 density constant {} nspheres {} ntry "
      "{} spheres file {} scale 1.0 type {} mass {} inertia_tensor {} {} {} {} {} {} use_volume\n",
      name, seed, float_text(body.mass / sum), spheres.size(), kTries, file, type, float_text(body.mass),
      float_text(i(0, 0)), float_text(i(0, 1)), float_text(i(0, 2)), float_text(i(1, 1)), float_text(i(1, 2)),
      float_text(i(2, 2)));
}

}  // namespace

Files write_liggghts(const SphereModel& model, const FormatOptions& options) {
  Files files;
  const std::vector<std::string> stems = file_stems(model);
  std::string include =
      comments(model, "# ") +
      "# A template for each link: spheres in the link's frame, which LIGGGHTS moves to the centre of mass of their\n"
      "# union; masses and inertias about the centre of mass are the links' own. A link of one sphere is a template of "
      "a\n"
      "# single sphere, since those of several have two or more.\n";
  Index seed = 10'000, type = 0;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const std::vector<Sphere>& spheres = model.groups[g].spheres;
    const std::string file = identifier(fmt::format("{}-liggghts-{}", options.prefix, stems[g])) + ".txt";
    files.push_back({file, lines_of(spheres), ""});
    seed = next_prime(seed);
    const std::string name = identifier(model.groups[g].name);
    include += spheres.size() == 1 ? single_template(name, seed, spheres.front(), model.bodies[g])
                                   : template_of(name, seed, spheres, model.bodies[g], file, ++type);
  }
  files.push_back({options.prefix + "-liggghts.in", include, "a template for each link, for LIGGGHTS to include"});
  return files;
}

Files write_lammps(const SphereModel& model, const FormatOptions& options) {
  Files files;
  const std::vector<std::string> stems = file_stems(model);
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    files.push_back({fmt::format("{}-lammps-{}.mol", options.prefix, stems[g]), molecule(model, g),
                     g == 0 ? "and one for each other link, molecules for LAMMPS" : ""});
  return files;
}

Files write_yade(const SphereModel& model, const FormatOptions& options) {
  std::string text =
      comments(model, "# ") +
      "# Each function adds a link as one clump, in the link's frame, and returns the clump's number and those\n"
      "# of its spheres.\nfrom yade import *\nfrom yade.utils import sphere\n";
  for (const apps::SphereGroup& group : model.groups) {
    text += fmt::format("\n\ndef add_{}(**material):\n    return O.bodies.appendClumped([\n", identifier(group.name));
    for (const Sphere& s : group.spheres)
      text += fmt::format("        sphere(({}), {}, **material),\n", point_text(s.center, ", "), float_text(s.radius));
    text += "    ])\n";
  }
  return {{options.prefix + "-yade.py", text, "clumps for YADE"}};
}

}  // namespace orchard::robot
