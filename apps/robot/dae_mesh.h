#pragma once
#include <filesystem>

#include "orchard/geometry/mesh.h"

namespace orchard::robot {

// How loaders of COLLADA differ.
struct DaeOptions {
  bool units = true;  // apply <unit meter>; without it, numbers count as metres
  bool up = true;     // turn the up-axis to z; without it, coordinates stay as they are
};

// The triangles of a COLLADA file's scene, each mesh as often as the scene has it, moved by its nodes, in metres with z
// up; identical corners of a mesh are one. Coordinates pass through floats. By Assimp. Throws InputError if the file
// cannot be read or has no triangle.
TriangleMesh read_dae(const std::filesystem::path& file, const DaeOptions& options = {});

}  // namespace orchard::robot
