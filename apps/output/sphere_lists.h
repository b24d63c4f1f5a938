#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "orchard/spheretree/tree.h"

// Sphere-trees and lists of spheres of any system: what compare reads and build --export writes.
namespace orchard::apps {

using Level = std::vector<Sphere>;

struct SphereLists {
  std::vector<Level> levels;       // the root first; a leaf stands on the deeper levels too, in `carried`
  std::vector<Level> carried;      // leaves of the levels above, for each level
  std::optional<SphereTree> tree;  // if the file says who is whose child
};

SphereLists levels_of(const SphereTree& tree);

// Reads .orchard, .sph, or .json: a list of levels, each a list of spheres or an object with "spheres", each sphere
// [x, y, z, r] or an object with "origin" (or "center") and "radius". Throws InputError.
SphereLists read_spheres(const std::filesystem::path& file);

nlohmann::json to_json(const SphereLists& lists);
// One link with the spheres of a level as its collision geometry; below the deepest level stand all leaves.
std::string to_urdf(const SphereLists& lists, std::size_t level, const std::string& link);

}  // namespace orchard::apps
