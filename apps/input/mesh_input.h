#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/progress.h"

// Reads the mesh of a command. All commands use these functions, for files of any program.
namespace orchard::apps {

// The options that say how to read a mesh file.
struct MeshInput {
  std::string format = {};  // a name of input_formats(); empty for the extension of the file
  double scale = 1;         // the coordinates are multiplied by it
  std::string unit = {};    // printed and written with lengths; empty for the unit of the file, if it has one
  bool operator==(const MeshInput&) const = default;
};

// Returns the names of all formats, in lower case without a dot: those of meshes, of scenes, and of points with
// normals.
std::vector<std::string> input_formats();
// Returns the same as "(.obj, .ply, .. or .xyz)".
std::string input_formats_in_words();
// Whether a file has the extension of a mesh. This excludes .xyz.
bool is_mesh_name(const std::filesystem::path& file);

// Reads a mesh by geometry/mesh_io.h, or by scene_mesh.h. Points with normals become a closed surface
// (geometry/reconstruct.h), with its distances in the report. Throws InputError as these do.
MeshReading read_input(const std::filesystem::path& file, const MeshInput& input, const Progress& progress = {});
// The same, but points are not turned into a surface: the mesh then has no triangles.
MeshReading read_input_or_points(const std::filesystem::path& file, const MeshInput& input);

}  // namespace orchard::apps
