#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "input/mesh_input.h"

// What files hold that are no meshes and no trees. Each report has "kind", "diagonal" (of the box around the balls or
// points) and "bounds" (its two corners), in the file's own unit.
namespace orchard::apps {

// An axis of any system: balls, edges, triangles, parts of its structure, Betti numbers, radii, area and border length.
// Throws InputError as read_axis() does.
nlohmann::json inspect_axis(const std::filesystem::path& file);
// Spheres of one object or of each link of a robot. Throws InputError as read_sphere_file() does.
nlohmann::json inspect_spheres(const std::filesystem::path& file);
// The points of a file without triangles; nothing if it has any. Throws InputError as read_input_or_points() does.
std::optional<nlohmann::json> inspect_points(const std::filesystem::path& file, const MeshInput& input);

}  // namespace orchard::apps
