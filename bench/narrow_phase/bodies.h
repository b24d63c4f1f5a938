#pragma once
#include <array>
#include <string>
#include <vector>

#include "orchard/runtime/packed_tree.h"
#include "rival.h"

namespace orchard::bench {

// An .orchard file, or an .obj of triangles, which gets a tree by median splits. Ends the program if there is none.
runtime::PackedSphereTree read_body(const std::string& path);

inline constexpr int kClasses = 6;
inline constexpr std::array<const char*, kClasses> kClassNames = {"spheres touch", "half-way",     "gap 1 % R",
                                                                  "gap 0.1 % R",   "pen. 0.1 % R", "pen. 1 % R"};

// Poses of 7.2's kind of two copies of a body, one of each class from every approach: both turned at random, the second
// one coming along a random line through the first one's root centre until the surfaces meet.
std::vector<Query> approaches(const runtime::TreeView& tree, std::size_t count, std::uint64_t first_seed);

}  // namespace orchard::bench
