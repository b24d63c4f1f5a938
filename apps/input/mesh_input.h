#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/progress.h"

// The one way in which commands read the mesh that they are given, whichever program wrote it.
namespace orchard::apps {

// What the user says of a mesh file.
struct MeshInput {
  std::string format = {};  // a name of input_formats(); empty: the extension of the file
  double scale = 1;         // the coordinates are multiplied by it
  std::string unit = {};    // of the mesh as it is used, for what is printed and written; empty: the file's, if any
  bool operator==(const MeshInput&) const = default;
};

// The names of all formats, in lower case without a dot: those of meshes, of scenes, and of points with normals.
std::vector<std::string> input_formats();
// The same as "(.obj, .ply, .. or .xyz)".
std::string input_formats_in_words();
// Whether the name of a file ends like that of a mesh; .xyz does not.
bool is_mesh_name(const std::filesystem::path& file);

// Reads a mesh by geometry/mesh_io.h, or by scene_mesh.h. Points with normals become a closed surface
// (geometry/reconstruct.h), with its distances in the report. Throws InputError as these do.
MeshReading read_input(const std::filesystem::path& file, const MeshInput& input, const Progress& progress = {});
// The same, but points stay points: the mesh has no triangles then.
MeshReading read_input_or_points(const std::filesystem::path& file, const MeshInput& input);

}  // namespace orchard::apps
