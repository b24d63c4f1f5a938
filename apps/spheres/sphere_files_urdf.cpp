#include <fmt/format.h>
#include <tinyxml2.h>

#include <charconv>

#include "input/input_file.h"
#include "orchard/geometry/error.h"
#include "spheres/sphere_files.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

std::string at_line(const fs::path& file, const XMLElement& element) {
  return fmt::format("{}, line {}", file.string(), element.GetLineNum());
}

// Numbers parted by blanks. Those that are not finite are the caller's to refuse.
std::vector<double> numbers_in(const std::string& text, std::size_t count, const std::string& where, const char* what) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto skip_blanks = [&] {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')) ++at;
  };
  for (skip_blanks(); at != end; skip_blanks()) {
    const auto [next, error] = std::from_chars(*at == '+' ? at + 1 : at, end, numbers.emplace_back());
    if (error != std::errc()) break;
    at = next;
  }
  if (at != end || numbers.size() != count)
    throw InputError(
        fmt::format("{}: {} is to be {} number{}, and is \"{}\"", where, what, count, count == 1 ? "" : "s", text));
  return numbers;
}

// A turn about the sphere's own centre changes nothing, so rpy is not read.
void add_collision(SphereGroup& group, const XMLElement& collision, const XMLElement& sphere, const fs::path& file) {
  const char* radius = sphere.Attribute("radius");
  if (radius == nullptr) throw InputError(at_line(file, sphere) + ": a sphere has no radius");
  Point center = Point::Zero();
  const XMLElement* origin = collision.FirstChildElement("origin");
  if (const char* xyz = origin != nullptr ? origin->Attribute("xyz") : nullptr; xyz != nullptr) {
    const std::vector<double> at = numbers_in(xyz, 3, at_line(file, *origin), "xyz");
    center = Point(at[0], at[1], at[2]);
  }
  const std::string where = at_line(file, sphere);
  add_sphere(group, center, numbers_in(radius, 1, where, "a radius").front(), where);
}

SphereGroup spheres_of_link(const XMLElement& link, const fs::path& file) {
  SphereGroup group;
  if (const char* name = link.Attribute("name"); name != nullptr) group.name = name;
  for (const XMLElement* collision = link.FirstChildElement("collision"); collision != nullptr;
       collision = collision->NextSiblingElement("collision")) {
    const XMLElement* geometry = collision->FirstChildElement("geometry");
    const XMLElement* sphere = geometry != nullptr ? geometry->FirstChildElement("sphere") : nullptr;
    if (sphere != nullptr) add_collision(group, *collision, *sphere, file);
  }
  return group;
}

}  // namespace

SphereFile read_urdf_spheres(const fs::path& file) {
  const std::string text = content_of(file);
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw InputError(fmt::format("{}, line {}: is no well-formed XML ({})", file.string(), document.ErrorLineNum(),
                                 document.ErrorName()));
  const XMLElement* robot = document.RootElement();
  if (robot == nullptr) throw InputError(file.string() + ": is no URDF: it has no element");
  if (std::string_view(robot->Name()) != "robot")
    throw InputError(
        fmt::format("{}: is no URDF: its root is <{}> rather than <robot>", at_line(file, *robot), robot->Name()));
  SphereFile result{"URDF", {}};
  for (const XMLElement* link = robot->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link"))
    result.groups.push_back(spheres_of_link(*link, file));
  return result;
}

}  // namespace orchard::apps
