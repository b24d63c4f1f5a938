#pragma once
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

namespace orchard::runtime::detail {

// By which coordinates a tree's triangles reach, in the frame that its poses place. Infinite where it has none.
struct SupportBox {
  Vec3 low, high;
};
// By PackedSphereTree::supports, and so for flexible trees, too, as long as they are.
SupportBox support_box(const TreeView& tree) noexcept;

}  // namespace orchard::runtime::detail
