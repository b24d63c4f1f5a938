#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "orchard/geometry/error.h"
#include "sphere_files.h"
#include "xml_reader.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

std::string at_line(const fs::path& file, const XmlElement& element) {
  return fmt::format("{}, line {}", file.string(), element.line);
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

// A turn about the sphere's own centre changes nothing, so that rpy is of no matter.
void add_collision(SphereGroup& group, const XmlElement& collision, const XmlElement& sphere, const fs::path& file) {
  const std::string* radius = sphere.attribute("radius");
  if (radius == nullptr) throw InputError(at_line(file, sphere) + ": a sphere has no radius");
  Point center = Point::Zero();
  if (const XmlElement* origin = collision.child("origin"); origin != nullptr)
    if (const std::string* xyz = origin->attribute("xyz"); xyz != nullptr) {
      const std::vector<double> at = numbers_in(*xyz, 3, at_line(file, *origin), "xyz");
      center = Point(at[0], at[1], at[2]);
    }
  const std::string where = at_line(file, sphere);
  add_sphere(group, center, numbers_in(*radius, 1, where, "a radius").front(), where);
}

}  // namespace

SphereFile read_urdf_spheres(const fs::path& file) {
  const XmlElement robot = read_xml(file);
  if (robot.name != "robot")
    throw InputError(
        fmt::format("{}: is no URDF: its root is <{}> rather than <robot>", at_line(file, robot), robot.name));
  SphereFile result{"URDF", {}};
  for (const XmlElement& link : robot.children) {
    if (link.name != "link") continue;
    SphereGroup group;
    if (const std::string* name = link.attribute("name"); name != nullptr) group.name = *name;
    for (const XmlElement& collision : link.children) {
      if (collision.name != "collision") continue;
      const XmlElement* geometry = collision.child("geometry");
      const XmlElement* sphere = geometry != nullptr ? geometry->child("sphere") : nullptr;
      if (sphere != nullptr) add_collision(group, collision, *sphere, file);
    }
    result.groups.push_back(std::move(group));
  }
  return result;
}

}  // namespace orchard::apps
