#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "orchard/geometry/mesh_io.h"
#include "vertex_faults.h"

namespace orchard {

// CGAL's readers of STL and OFF trust a file: they allocate memory for as many vertices as it announces, convert any
// number to an index, accept a single spelling of STL, and report that something went wrong but not where. These
// functions check a file first. They return bytes that are safe to read, or throw InputError with the line or byte.
// Parts that they leave out are in the report. Linear, except for binary STL whose count and length disagree: n log n.

// Returns STL in the plain form of either encoding. In a binary file, there are as many facets as the header counts; if
// the length of the file disagrees, the bytes that follow count as facets if they are facets, with or without the
// attributes between them. In a text, keywords may be in capitals, in two words ("end loop"), and several on a line.
std::string checked_stl(std::string_view bytes, const std::string& name, MeshReadReport& report);

struct CheckedOff {
  std::string bytes = {};
  std::vector<std::size_t> face_at = {};  // byte of each face's line in the file
  VertexFaults vertex_faults = {};  // the vertices that the file has no place for, and that are at the origin therefore
};
CheckedOff checked_off(std::string_view bytes, const std::string& name, MeshReadReport& report);

// The two halves of checked_stl(), in stl_binary.cpp and stl_ascii.cpp.
std::string checked_binary_stl(std::string_view bytes, const std::string& name, MeshReadReport& report);
std::string checked_ascii_stl(std::string_view bytes, const std::string& name, MeshReadReport& report);

}  // namespace orchard
