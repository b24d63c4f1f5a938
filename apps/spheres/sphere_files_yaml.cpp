#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "orchard/geometry/error.h"
#include "spheres/sphere_files.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

std::string at_line(const fs::path& file, const YAML::Mark& mark) {
  return mark.is_null() ? file.string() : fmt::format("{}, line {}", file.string(), mark.line + 1);
}

double number(const YAML::Node& node, const fs::path& file, const char* what) {
  double value = 0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value))
    throw InputError(fmt::format("{}: {} is no number", at_line(file, node.Mark()), what));
  return value;
}

// Buffers are one number for all links, or one for each by its name.
double buffer_of(const YAML::Node& buffers, const std::string& link, const fs::path& file) {
  if (!buffers || buffers.IsNull()) return 0;
  if (buffers.IsScalar()) return number(buffers, file, "the buffer");
  const YAML::Node own = buffers.IsMap() ? buffers[link] : YAML::Node();
  return own && !own.IsNull() ? number(own, file, "a link's buffer") : 0;
}

void add_link(SphereFile& result, const std::string& link, const YAML::Node& spheres, double buffer,
              const fs::path& file) {
  if (!spheres.IsSequence()) {
    if (spheres.IsNull()) return;
    throw InputError(fmt::format("{}: the spheres of {} are no list", at_line(file, spheres.Mark()), link));
  }
  SphereGroup& group = result.groups.emplace_back();
  group.name = link;
  group.buffer = buffer;
  for (const YAML::Node& sphere : spheres) {
    const std::string where = at_line(file, sphere.Mark());
    const YAML::Node center = sphere.IsMap() ? sphere["center"] : YAML::Node(),
                     radius = sphere.IsMap() ? sphere["radius"] : YAML::Node();
    if (!center || !radius || !center.IsSequence() || center.size() != 3)
      throw InputError(where + ": a sphere needs a center of three numbers and a radius");
    add_sphere(group,
               Point(number(center[0], file, "a coordinate"), number(center[1], file, "a coordinate"),
                     number(center[2], file, "a coordinate")),
               number(radius, file, "the radius"), where);
  }
}

void add_links(SphereFile& result, const YAML::Node& links, const YAML::Node& buffers, const fs::path& file) {
  for (const auto& link : links)
    add_link(result, link.first.as<std::string>(), link.second, buffer_of(buffers, link.first.as<std::string>(), file),
             file);
}

// Isaac's: geometry / NAME / spheres / LINK, where collision / geometry says which, and collision / buffer_distance.
SphereFile read_xrdf(const YAML::Node& root, const fs::path& file) {
  SphereFile result{"XRDF", {}};
  const YAML::Node collision = root["collision"];
  const YAML::Node chosen = collision ? collision["geometry"] : YAML::Node();
  for (const auto& geometry : root["geometry"]) {
    if (chosen && chosen.IsScalar() && chosen.Scalar() != geometry.first.Scalar()) continue;
    if (geometry.second.IsMap() && geometry.second["spheres"])
      add_links(result, geometry.second["spheres"], collision ? collision["buffer_distance"] : YAML::Node(), file);
  }
  return result;
}

SphereFile read_curobo(const YAML::Node& root, const fs::path& file) {
  YAML::Node kinematics = root["robot_cfg"] ? root["robot_cfg"] : root;
  if (kinematics["kinematics"]) kinematics = kinematics["kinematics"];
  const YAML::Node spheres = kinematics["collision_spheres"];
  SphereFile result{"cuRobo's YAML", {}};
  if (!spheres)
    throw InputError(file.string() +
                     ": the file has neither collision_spheres, as in cuRobo's files, nor geometry, as in XRDF");
  if (spheres.IsScalar())
    throw InputError(fmt::format("{}: its spheres are in another file, {}; audit that one",
                                 at_line(file, spheres.Mark()), spheres.Scalar()));
  add_links(result, spheres, kinematics["collision_sphere_buffer"], file);
  return result;
}

}  // namespace

SphereFile read_yaml_spheres(const fs::path& file) {
  try {
    const YAML::Node root = YAML::LoadFile(file.string());
    if (!root.IsMap())
      throw InputError(file.string() + ": the file is no robot of cuRobo or Isaac, since it has no keys");
    return root["geometry"] && root["geometry"].IsMap() ? read_xrdf(root, file) : read_curobo(root, file);
  } catch (const YAML::BadFile&) {
    throw InputError(file.string() + ": the file cannot be opened; check that it exists and its permissions");
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}: the file is no YAML: {}", at_line(file, error.mark), error.msg));
  }
}

}  // namespace orchard::apps
