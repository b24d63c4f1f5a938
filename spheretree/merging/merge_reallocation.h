#pragma once
#include <vector>

#include "child_builder.h"
#include "orchard/spheretree/tree.h"

namespace orchard::detail {

// Takes out what the last level of a closed tree can do without, and returns how many nodes that are. Points of a node
// that is gone go to the tightest leaf of those that they have a path to. portions[i]: of node i.
Index remove_redundant_nodes(SphereTree& tree, const Surface& surface, std::vector<Portion>& portions);

// Splits the loosest spheres, as long as the level has room: `branching` spheres for each family that is not empty, up
// to max_children() in one.
void split_loosest(const ChildBuilder& maker, Index branching, std::vector<std::vector<Child>>& families);

}  // namespace orchard::detail
