#pragma once
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// A number for each vertex, or for each triangle, of a mesh.
struct MeshArray {
  std::string name;  // a word
  std::vector<double> values;
};

// The bytes of a binary little-endian PLY file of the mesh, coordinates and values as doubles; arrays are properties of
// their names of the elements "vertex" and "face", and `comments` are lines of the header. NaN is written as it is. The
// same bytes for the same values. Precondition: arrays are as long as the mesh has vertices or triangles.
std::string to_ply(const TriangleMesh& mesh, std::span<const MeshArray> of_vertices,
                   std::span<const MeshArray> of_triangles, std::span<const std::string> comments = {});

}  // namespace orchard
