#pragma once
#include <filesystem>
#include <string>

#include "orchard/spheretree/tree.h"

namespace orchard {

// The .sph text of the existing sphere-tree toolkit: "levels branching" (levels count the root), then the nodes of the
// complete tree in breadth-first order, "x y z radius importance", radius < 0 for an unused one; 17 significant digits,
// in the mesh's own frame.
std::string to_sph(const SphereTree& tree);

// Reads a .sph file. Nodes of radius 0 count as unused; blank lines and lines that start with '#' are skipped. Throws
// InputError naming file, line, fault and remedy.
SphereTree read_sph(const std::filesystem::path& file);

}  // namespace orchard
