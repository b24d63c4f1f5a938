#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "orchard/geometry/mesh_io.h"
#include "vertex_faults.h"

namespace orchard {

// CGAL's readers of STL and OFF take a file at its word: they make room for as many vertices as it promises, convert
// any number to an index, know one spelling of STL, and say only that something went wrong, not where. These check a
// file first, and return bytes that are safe to read, or throw InputError naming line or byte. What they leave out is
// in the report. Linear, but for binary STL whose count and length disagree: n log n.

// STL in the plain form of either encoding. Binary: as many facets as the header counts; where the length of the file
// says otherwise, those behind them that are facets too, or without the attributes between them. Text: keywords in
// capitals or not, in two words ("end loop"), several on a line.
std::string checked_stl(std::string_view bytes, const std::string& name, MeshReadReport& report);

struct CheckedOff {
  std::string bytes = {};
  std::vector<std::size_t> face_at = {};  // byte of each face's line in the file
  VertexFaults vertex_faults = {};        // which vertices are at the origin since the file has no place for them
};
CheckedOff checked_off(std::string_view bytes, const std::string& name, MeshReadReport& report);

// stl_binary.cpp and stl_ascii.cpp: the two halves of checked_stl().
std::string checked_binary_stl(std::string_view bytes, const std::string& name, MeshReadReport& report);
std::string checked_ascii_stl(std::string_view bytes, const std::string& name, MeshReadReport& report);

}  // namespace orchard
