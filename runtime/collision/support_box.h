#pragma once
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime::detail {

// By which coordinates a tree's triangles reach, in the frame that its poses place. Infinite where it has none.
struct SupportBox {
  std::array<double, 3> low, high;
};
// By PackedSphereTree::supports, and so for flexible trees, too, as long as they are.
SupportBox support_box(const TreeView& tree) noexcept;

}  // namespace orchard::runtime::detail
