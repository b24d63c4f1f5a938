#pragma once
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "mesh_formats.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_check.h"

namespace orchard::test {

// What every reader owes to any bytes at all: a valid mesh no larger than the bytes can make it, or InputError with one
// line that begins with the file's name. Anything else leaves as another exception. Returns whether there is a mesh.
inline bool read_bytes(TriangleMesh (*reader)(std::string_view, const std::string&), const std::uint8_t* data,
                       std::size_t size) {
  TriangleMesh mesh;
  try {
    mesh = reader({reinterpret_cast<const char*>(data), size}, "bytes");
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    if (!message.starts_with("bytes") || message.find('\n') != message.npos || message.size() > 300) {
      throw std::logic_error("not a message to show to a user: " + std::string(message));
    }
    return false;
  }
  try {
    validate(mesh);
  } catch (const InputError& error) {
    throw std::logic_error("the reader let through what validate() refuses: " + std::string(error.what()));
  }
  if (mesh.vertices.size() > size || mesh.triangles.size() > size) throw std::logic_error("larger than its file");
  check_mesh(mesh);
  return true;
}

}  // namespace orchard::test
