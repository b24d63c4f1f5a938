#include "output/sphere_lists.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "orchard/geometry/error.h"
#include "orchard/geometry/xml_escaped.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/tree_io.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

Sphere parse_sphere(const json& item) {
  if (item.is_array() && item.size() == 4)
    return {Point(item[0].get<double>(), item[1].get<double>(), item[2].get<double>()), item[3].get<double>()};
  const json& center = item.contains("origin") ? item.at("origin") : item.at("center");
  return {Point(center.at(0).get<double>(), center.at(1).get<double>(), center.at(2).get<double>()),
          item.at("radius").get<double>()};
}

SphereLists read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": the file cannot be opened; check that it exists and its permissions");
  SphereLists lists;
  try {
    const json parsed = json::parse(in);
    const json& levels = parsed.is_object() ? parsed.at("levels") : parsed;
    for (const json& level : levels) {
      lists.levels.emplace_back();
      for (const json& item : level.is_object() ? level.at("spheres") : level) {
        const Sphere sphere = parse_sphere(item);
        if (!sphere.center.allFinite() || !(sphere.radius >= 0) || !std::isfinite(sphere.radius))
          throw InputError(file.string() + ": level " + std::to_string(lists.levels.size() - 1) +
                           " has a sphere that is not finite; write it again");
        if (sphere.radius > 0) lists.levels.back().push_back(sphere);
      }
    }
  } catch (const json::exception& error) {
    throw InputError(file.string() + ": the file is not a list of levels of spheres: " + error.what());
  }
  if (lists.levels.empty()) throw InputError(file.string() + ": the file has no level");
  lists.carried.resize(lists.levels.size());
  return lists;
}

}  // namespace

SphereLists levels_of(const SphereTree& tree) {
  SphereLists lists;
  lists.levels.resize(tree.depth() + 1);
  lists.carried.resize(tree.depth() + 1);
  for (const SphereNode& node : tree.nodes) {
    lists.levels[node.level].push_back(node.sphere);
    if (node.child_count > 0) continue;
    for (Index level = node.level + 1; level <= tree.depth(); ++level) lists.carried[level].push_back(node.sphere);
  }
  lists.tree = tree;
  return lists;
}

SphereLists read_spheres(const std::filesystem::path& file) {
  if (file.extension() == ".json") return read_json(file);
  if (file.extension() == ".sph") return levels_of(read_sph(file));
  runtime::PackedSphereTree packed;
  const auto status = runtime::load_file(file.c_str(), packed);
  if (status != runtime::LoadStatus::ok) throw InputError(file.string() + ": " + runtime::message(status));
  return levels_of(unpack(packed));
}

json to_json(const SphereLists& lists) {
  json levels = json::array();
  for (std::size_t level = 0; level < lists.levels.size(); ++level) {
    json spheres = json::array();
    for (const Level* list : {&lists.levels[level], &lists.carried[level]})
      for (const Sphere& s : *list)
        spheres.push_back({{"origin", {s.center.x(), s.center.y(), s.center.z()}}, {"radius", s.radius}});
    levels.push_back({{"spheres", std::move(spheres)}});
  }
  return levels;
}

std::string to_urdf(const SphereLists& lists, std::size_t level, const std::string& link) {
  level = std::min(level, lists.levels.size() - 1);
  const std::string escaped = xml_escaped(link);
  std::string text = fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{0}\">\n  <link name=\"{0}\">\n", escaped);
  for (const Level* list : {&lists.levels[level], &lists.carried[level]})
    for (const Sphere& s : *list)
      text += fmt::format(
          "    <collision>\n      <origin xyz=\"{} {} {}\" rpy=\"0 0 0\"/>\n      <geometry><sphere "
          "radius=\"{}\"/></geometry>\n    </collision>\n",
          s.center.x(), s.center.y(), s.center.z(), s.radius);
  return text + "  </link>\n</robot>\n";
}

}  // namespace orchard::apps
