#include <fmt/format.h>

#include <cstring>
#include <map>
#include <string_view>

#include "input/xml_file.h"
#include "orchard/geometry/error.h"
#include "robot/urdf_values.h"
#include "spheres/sphere_files.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

std::string attribute(const XMLElement& element, const char* name, const fs::path& file) {
  if (const char* value = element.Attribute(name); value != nullptr) return value;
  throw InputError(fmt::format("{}: <{}> has no {}", at_line(file, element), element.Name(), name));
}

Point point_in(const std::string& text, const std::string& where, const char* what) {
  const std::vector<double> numbers = numbers_in(text, 3, where, what);
  return {numbers[0], numbers[1], numbers[2]};
}

// A turn about the sphere's own centre changes nothing, so rpy is not read.
void add_collision(SphereGroup& group, const XMLElement& collision, const XMLElement& sphere, const fs::path& file) {
  const std::string radius = attribute(sphere, "radius", file);
  Point center = Point::Zero();
  const XMLElement* origin = collision.FirstChildElement("origin");
  if (const char* xyz = origin != nullptr ? origin->Attribute("xyz") : nullptr; xyz != nullptr)
    center = point_in(xyz, at_line(file, *origin), "xyz");
  const std::string where = at_line(file, sphere);
  add_sphere(group, center, numbers_in(radius, 1, where, "a radius").front(), where);
}

SphereGroup spheres_of_link(const XMLElement& link, const fs::path& file) {
  SphereGroup group;
  if (const char* name = link.Attribute("name"); name != nullptr) group.name = name;
  for (const XMLElement* collision : children_of(link, "collision")) {
    const XMLElement* geometry = collision->FirstChildElement("geometry");
    const XMLElement* sphere = geometry != nullptr ? geometry->FirstChildElement("sphere") : nullptr;
    if (sphere != nullptr) add_collision(group, *collision, *sphere, file);
  }
  return group;
}

// The name before "_sphere" and digits; empty: the name is none of those.
std::string carrier_of(const std::string& name) {
  constexpr std::string_view kMark = "_sphere";
  const std::size_t at = name.rfind(kMark);
  if (at == std::string::npos || at == 0 || at + kMark.size() == name.size()) return {};
  const bool digits = name.find_first_not_of("0123456789", at + kMark.size()) == std::string::npos;
  return digits ? name.substr(0, at) : std::string();
}

// MorphIt's robots have a link LINK_sphereK for each sphere, which hangs on LINK by a fixed joint: its sphere is one of
// LINK.
void join_carried(const XMLElement& robot, const fs::path& file, std::vector<SphereGroup>& groups) {
  std::map<std::string, std::size_t> places;
  for (std::size_t g = 0; g < groups.size(); ++g) places[groups[g].name] = g;
  for (const XMLElement* joint : children_of(robot, "joint")) {
    const XMLElement *parent = joint->FirstChildElement("parent"), *child = joint->FirstChildElement("child");
    const char* type = joint->Attribute("type");
    if (parent == nullptr || child == nullptr || type == nullptr || std::strcmp(type, "fixed") != 0) continue;
    const std::string link = attribute(*parent, "link", file), carried = attribute(*child, "link", file);
    if (carrier_of(carried) != link || !places.contains(link) || !places.contains(carried)) continue;
    SphereGroup &whole = groups[places[link]], &one = groups[places[carried]];
    const robot::Motion origin = robot::read_origin(*joint, file);
    for (const Sphere& sphere : one.spheres) whole.spheres.push_back({origin * sphere.center, sphere.radius});
    whole.switched_off += one.switched_off;
    one.spheres.clear();
    one.switched_off = 0;
  }
}

// Spheres of a body and of those within it.
void add_bodies(SphereFile& result, const XMLElement& parent, const fs::path& file) {
  for (const XMLElement* body : children_of(parent, "body")) {
    SphereGroup group;
    if (const char* name = body->Attribute("name"); name != nullptr) group.name = name;
    for (const XMLElement* geom : children_of(*body, "geom")) {
      const char* type = geom->Attribute("type");
      if (type != nullptr && std::strcmp(type, "sphere") != 0) continue;  // a sphere is what a geom is by default
      const std::string where = at_line(file, *geom);
      const char* place = geom->Attribute("pos");
      const Point center = place == nullptr ? Point(Point::Zero()) : point_in(place, where, "pos");
      const std::string size = attribute(*geom, "size", file);
      add_sphere(group, center, numbers_in(size, 1, where, "the size of a sphere").front(), where);
    }
    result.groups.push_back(std::move(group));
    add_bodies(result, *body, file);
  }
}

}  // namespace

SphereFile read_urdf_spheres(const fs::path& file) {
  XMLDocument document;
  SphereFile result{"URDF", {}};
  const XMLElement& robot = parse_xml(file, document, "robot", "URDF");
  for (const XMLElement* link : children_of(robot, "link")) result.groups.push_back(spheres_of_link(*link, file));
  join_carried(robot, file, result.groups);
  return result;
}

SphereFile read_srdf_spheres(const fs::path& file) {
  XMLDocument document;
  SphereFile result{"SRDF", {}};
  for (const XMLElement* link : children_of(parse_xml(file, document, "robot", "SRDF"), "link_sphere_approximation")) {
    SphereGroup group;
    group.name = attribute(*link, "link", file);
    group.frame = SphereFrame::element;
    for (const XMLElement* sphere : children_of(*link, "sphere")) {
      const std::string where = at_line(file, *sphere);
      const Point center = point_in(attribute(*sphere, "center", file), where, "center");
      add_sphere(group, center, numbers_in(attribute(*sphere, "radius", file), 1, where, "a radius").front(), where);
    }
    result.groups.push_back(std::move(group));
  }
  return result;
}

SphereFile read_mjcf_spheres(const fs::path& file) {
  XMLDocument document;
  SphereFile result{"MJCF", {}};
  const XMLElement& root = parse_xml(file, document, "mujoco", "MJCF");
  for (const XMLElement* world : children_of(root, "worldbody")) add_bodies(result, *world, file);
  return result;
}

}  // namespace orchard::apps
