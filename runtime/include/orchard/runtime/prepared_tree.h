#pragma once
#include <array>
#include <cstdint>

#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime {

// What every query needs to know of a tree and would otherwise work out anew: made once per tree and shared by all
// pairs that the tree is part of, in any number of threads. O(nodes + triangles), some 0.1 ms for 1000 triangles;
// allocates nothing and throws nothing. Precondition: structure_fault(tree) is nullptr, and what the view refers to
// outlives this object unchanged.
struct PreparedTree {
  PreparedTree() = default;
  explicit PreparedTree(const TreeView& view) noexcept;

  TreeView tree;
  std::array<double, 3> root{}, middle{};   // the root's centre, with and without the tree's origin
  double radius = 0, reach = 0, depth = 0;  // the root's; `reach` is its error
  double error = 0;                         // how far a point may be off, whatever the pose
  double extent = 0;                        // coordinate_extent()
  int bits = 0;                             // link_bits() of the tree
  std::uint64_t fingerprint = 0;            // of everything stored: equal for copies of one tree
};

}  // namespace orchard::runtime
