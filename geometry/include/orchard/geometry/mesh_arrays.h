#pragma once
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"

// Writes meshes with values at their vertices and triangles.
namespace orchard {

// A number for each vertex or each triangle of a mesh.
struct MeshArray {
  std::string name;  // A single word.
  std::vector<double> values;
};

// Returns a binary little-endian PLY file of a mesh, with coordinates and values as doubles. Each array is a property
// of the element "vertex" or "face", and `comments` are lines of the header. NaN is written as it is. The same values
// give the same bytes. Precondition: arrays are as long as the mesh has vertices or triangles.
std::string to_ply(const TriangleMesh& mesh, std::span<const MeshArray> of_vertices,
                   std::span<const MeshArray> of_triangles, std::span<const std::string> comments = {});

}  // namespace orchard
