#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/geometry/surface.h"

// Feature edges of a mesh as lines of a Wavefront OBJ file: what `orchard medial --features` reads and what it writes.
namespace orchard::apps {

// The edges of the mesh that the file's lines follow, as pairs of the mesh's vertices. Throws InputError, which names
// file and line, if there are no lines, or if one does not lead along an edge of the mesh from vertex to vertex.
std::vector<std::array<Index, 2>> read_feature_lines(const std::filesystem::path& file, const Surface& surface);

// One line for each edge.
std::string to_feature_lines(const Surface& surface, const std::vector<std::array<Index, 2>>& edges);

}  // namespace orchard::apps
