#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "input/input_file.h"
#include "orchard/geometry/error.h"
#include "spheres/sphere_files.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

bool is_sphere(const json& item) {
  if (item.is_array()) return item.size() == 4 && item[0].is_number();
  return item.is_object() && item.contains("radius");
}

bool has_centers(const json& item) { return item.is_object() && item.contains("centers") && item.contains("radii"); }

Point point_of(const json& center, const std::string& where) {
  if (!center.is_array() || center.size() != 3) throw InputError(where + ": a centre is not a list of three numbers");
  return {center[0].get<double>(), center[1].get<double>(), center[2].get<double>()};
}

void add_list(SphereGroup& group, const json& list, const std::string& where) {
  for (const json& item : list) {
    if (!is_sphere(item)) throw InputError(where + ": an item is not [x, y, z, r] and has no radius");
    if (item.is_array()) {
      add_sphere(group, Point(item[0].get<double>(), item[1].get<double>(), item[2].get<double>()),
                 item[3].get<double>(), where);
      continue;
    }
    const char* key = item.contains("origin") ? "origin" : "center";
    if (!item.contains(key)) throw InputError(where + ": a sphere has neither origin nor center");
    add_sphere(group, point_of(item.at(key), where), item.at("radius").get<double>(), where);
  }
}

void add_columns(SphereGroup& group, const json& columns, const std::string& where) {
  const json &centers = columns.at("centers"), &radii = columns.at("radii");
  if (!centers.is_array() || !radii.is_array() || centers.size() != radii.size())
    throw InputError(where + ": there must be as many radii as centers");
  const json masses = columns.value("masses", json::array());
  if (!masses.is_array() || (!masses.empty() && masses.size() != radii.size()))
    throw InputError(where + ": there must be as many masses as radii, or none");
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const std::size_t before = group.spheres.size();
    add_sphere(group, point_of(centers[i], where), radii[i].get<double>(), where);
    if (masses.empty() || group.spheres.size() == before) continue;
    group.masses.push_back(masses[i].get<double>());
    if (!(group.masses.back() >= 0) || !std::isfinite(group.masses.back()))
      throw InputError(fmt::format("{}: the mass of sphere {} is no finite number of 0 or more", where, i));
  }
}

// What may stand for one object or one link. Of levels, the deepest that holds a sphere counts.
void add_any(SphereGroup& group, const json& value, const std::string& where) {
  if (has_centers(value)) return add_columns(group, value, where);
  if (value.is_object() && value.contains("spheres")) return add_any(group, value.at("spheres"), where);
  if (value.is_object() && value.contains("levels")) return add_any(group, value.at("levels"), where);
  if (!value.is_array()) throw InputError(where + ": this is no list of spheres");
  if (value.empty()) return;
  if (is_sphere(value.front())) return add_list(group, value, where);
  for (auto level = value.rbegin(); level != value.rend(); ++level) {
    add_any(group, *level, where);
    if (!group.spheres.empty() || group.switched_off > 0) return;
  }
}

// What VAMP's generator reads: a URDF whose collision geometry is spheres, and more.
bool names_urdf(const json& root) {
  return root.is_object() && root.contains("urdf") && root.contains("srdf") && root.at("urdf").is_string();
}

SphereFile spheres_of(const json& root, const std::string& file) {
  if (root.is_object() && root.contains("collision_spheres")) return spheres_of(root.at("collision_spheres"), file);
  SphereFile result{"JSON", {}};
  const bool one = !root.is_object() || has_centers(root) || root.contains("spheres") || root.contains("levels");
  if (one) {
    add_any(result.groups.emplace_back(), root, file);
    return result;
  }
  for (const auto& [link, value] : root.items()) {
    SphereGroup& group = result.groups.emplace_back();
    group.name = link;
    add_any(group, value, fmt::format("{}: link {}", file, link));
  }
  return result;
}

}  // namespace

SphereFile read_json_spheres(const std::filesystem::path& file) {
  const std::string text = content_of(file);
  try {
    const json root = json::parse(text);
    if (names_urdf(root)) return read_urdf_spheres(file.parent_path() / root.at("urdf").get<std::string>());
    return spheres_of(root, file.string());
  } catch (const json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw InputError(fmt::format("{}, line {}: the file is no JSON; correct it or export it again", file.string(),
                                 1 + std::count(text.begin(), end, '\n')));
  } catch (const json::exception&) {
    throw InputError(file.string() + ": a value that must be a number is none");
  }
}

}  // namespace orchard::apps
