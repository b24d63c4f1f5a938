#pragma once
#include <filesystem>
#include <string>

#include "orchard/spheretree/tree.h"

// Reads and writes sphere-trees as .sph files.
namespace orchard {

// Returns the .sph text of the existing sphere-tree toolkit: a line "levels branching", where levels count the root,
// then a line "x y z radius importance" for each node of the complete tree in breadth-first order. The radius of an
// unused node is below 0. Numbers have 17 significant digits, in the frame of the mesh.
std::string to_sph(const SphereTree& tree);

// Reads a .sph file. Nodes of radius 0 count as unused. Blank lines and lines that start with '#' are skipped. Throws
// InputError, which names the file, the line, the fault and the remedy.
SphereTree read_sph(const std::filesystem::path& file);

}  // namespace orchard
