#pragma once
#include <cstdint>
#include <filesystem>

namespace orchard::apps {

// About how many triangles a mesh file has, from its header where that says so (.stl, .ply, .off), else by counting
// its faces (.obj), polygons as one, or from its size (other formats). 0 where the file is none that can be read: it
// costs nothing, either.
std::uint64_t count_triangles(const std::filesystem::path& mesh);

}  // namespace orchard::apps
