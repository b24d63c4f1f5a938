#pragma once
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

namespace orchard::runtime::detail {

// A box around the triangles of a tree, in the frame that poses place. It is infinite if the tree has no triangles.
struct SupportBox {
  Vec3 low, high;
};
// Returns the box, from PackedSphereTree::supports. So it also holds for a FlexibleTree, whatever its vertices do.
SupportBox support_box(const TreeView& tree) noexcept;

}  // namespace orchard::runtime::detail
