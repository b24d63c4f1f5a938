#pragma once
#include <string>
#include <string_view>

#include "io/mesh_formats.h"

namespace orchard::test {

// What a reader makes of bytes, for tests that do not ask what it left out.
inline TriangleMesh read_bytes(TriangleMesh (*reader)(std::string_view, const std::string&, MeshReadReport&),
                               std::string_view bytes, const std::string& name) {
  MeshReadReport report;
  return reader(bytes, name, report);
}

}  // namespace orchard::test
