#pragma once
#include <span>
#include <vector>

#include "orchard/spheretree/tree.h"
#include "output/array_files.h"

// Sphere-trees and sphere sets as arrays, for .npz and .csv files.
namespace orchard::apps {

// A row for each node, in the order of the tree, parents before their children: "spheres" (x, y, z, radius),
// "inaccuracy" (mesh units), "level" (0 for the root) and "parent" (the number of the node's row; -1 for the root).
std::vector<NamedArray> tree_arrays(const SphereTree& tree);

// A row for each sphere: "spheres" (x, y, z, radius) and, unless there are none, "mass".
std::vector<NamedArray> set_arrays(std::span<const Sphere> spheres, std::span<const double> masses);

}  // namespace orchard::apps
