#pragma once
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "io/mesh_formats.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_check.h"

namespace orchard::test {

using Reader = TriangleMesh (*)(std::string_view, const std::string&, MeshReadReport&);

// Reads, and returns whether there is a result. Throws unless a refusal is one line that begins with the file's name.
inline bool read_or_refuse(Reader reader, const std::uint8_t* data, std::size_t size, TriangleMesh& mesh) {
  try {
    MeshReadReport report;
    mesh = reader({reinterpret_cast<const char*>(data), size}, "bytes", report);
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    if (!message.starts_with("bytes") || message.find('\n') != message.npos || message.size() > 300) {
      throw std::logic_error("not a message to show to a user: " + std::string(message));
    }
    return false;
  }
  if (mesh.vertices.size() > size || mesh.triangles.size() > size) throw std::logic_error("larger than its file");
  return true;
}

// What every reader owes to any bytes at all: a valid mesh no larger than the bytes can make it, or InputError with one
// line that begins with the file's name. Anything else leaves as another exception. Returns whether there is a mesh.
inline bool read_bytes(Reader reader, const std::uint8_t* data, std::size_t size) {
  TriangleMesh mesh;
  if (!read_or_refuse(reader, data, size, mesh)) return false;
  try {
    validate(mesh);
  } catch (const InputError& error) {
    throw std::logic_error("the reader let through what validate() refuses: " + std::string(error.what()));
  }
  check_mesh(mesh);
  return true;
}

// The same for readers that need no faces: one finite point or more.
inline bool read_point_bytes(Reader reader, const std::uint8_t* data, std::size_t size) {
  TriangleMesh mesh;
  if (!read_or_refuse(reader, data, size, mesh)) return false;
  if (mesh.vertices.empty()) throw std::logic_error("the reader let through a file without points");
  for (const Point& point : mesh.vertices)
    if (!point.allFinite()) throw std::logic_error("the reader let through a point that is not finite");
  for (const auto& corners : mesh.triangles)
    for (const Index corner : corners)
      if (corner >= mesh.vertices.size()) throw std::logic_error("the reader let through an index out of range");
  return true;
}

}  // namespace orchard::test
