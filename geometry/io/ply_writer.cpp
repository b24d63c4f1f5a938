#include <bit>
#include <cstdint>

#include "orchard/geometry/mesh_arrays.h"

namespace orchard {
namespace {

template <class Bits>
void append(std::string& bytes, Bits bits) {
  for (std::size_t i = 0; i < sizeof(Bits); ++i) bytes.push_back(static_cast<char>((bits >> (8 * i)) & 0xff));
}

void append_double(std::string& bytes, double value) { append(bytes, std::bit_cast<std::uint64_t>(value)); }

void append_properties(std::string& header, std::span<const MeshArray> arrays) {
  for (const MeshArray& array : arrays) header += "property double " + array.name + "\n";
}

}  // namespace

std::string to_ply(const TriangleMesh& mesh, std::span<const MeshArray> of_vertices,
                   std::span<const MeshArray> of_triangles, std::span<const std::string> comments) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments) bytes += "comment " + comment + "\n";
  bytes += "element vertex " + std::to_string(mesh.vertices.size()) + "\n";
  for (const char* axis : {"x", "y", "z"}) bytes += std::string("property double ") + axis + "\n";
  append_properties(bytes, of_vertices);
  bytes += "element face " + std::to_string(mesh.triangles.size()) + "\nproperty list uchar uint vertex_indices\n";
  append_properties(bytes, of_triangles);
  bytes += "end_header\n";
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (const double coordinate : mesh.vertices[i]) append_double(bytes, coordinate);
    for (const MeshArray& array : of_vertices) append_double(bytes, array.values[i]);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    append(bytes, std::uint8_t{3});
    for (const Index corner : mesh.triangles[i]) append(bytes, corner);
    for (const MeshArray& array : of_triangles) append_double(bytes, array.values[i]);
  }
  return bytes;
}

}  // namespace orchard
