#pragma once
#include <filesystem>
#include <string>

#include "orchard/geometry/mesh_io.h"

struct aiScene;

// Reads files of scenes by Assimp: nodes that place meshes.
namespace orchard::apps {

// The formats that read_scene() reads: glb, gltf, 3mf, dae.
bool is_scene_format(const std::string& format);

// The triangles of a file's scene, each mesh as often as the scene has it and where its nodes place it. Identical
// corners of the meshes of a node are one vertex: glTF has one for each face where normals or colours differ.
// Coordinates pass through floats. Lengths: metres for glTF, the unit that a 3MF file names (the report has it), metres
// with z up for COLLADA. Throws InputError if the file cannot be read or has no triangle.
MeshReading read_scene(const std::filesystem::path& file, const std::string& format);

// The triangles of a scene that Assimp has read.
TriangleMesh triangles_of(const aiScene& scene);

}  // namespace orchard::apps
