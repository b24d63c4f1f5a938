#pragma once
#include <cstdint>
#include <filesystem>

namespace orchard::apps {

// Estimates the number of triangles of a mesh file: from its header (.stl, .ply, .off), by counting its faces with
// polygons as one (.obj), or from its size (other formats). Returns 0 if the file cannot be read; such a file costs
// nothing.
std::uint64_t count_triangles(const std::filesystem::path& mesh);

}  // namespace orchard::apps
