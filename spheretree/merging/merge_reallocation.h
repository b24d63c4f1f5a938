#pragma once
#include <vector>

#include "child_builder.h"
#include "orchard/spheretree/tree.h"

namespace orchard::detail {

// Removes redundant nodes of the last level of a closed tree, and returns their number. The points of a removed node go
// to the tightest leaf of those whose paths contain them. portions[i] is the portion of node i.
Index remove_redundant_nodes(SphereTree& tree, const Surface& surface, std::vector<Portion>& portions);

// Splits the loosest spheres as long as the level has room for more: `branching` spheres for each family that is not
// empty, and at most max_children() in one family.
void split_loosest(const ChildBuilder& maker, Index branching, std::vector<std::vector<Child>>& families);

}  // namespace orchard::detail
