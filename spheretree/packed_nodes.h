#pragma once
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard {

struct PackedNode {
  Index block, lane;
};

// The block and lane of each node of a packed tree, in breadth-first order. Precondition: structure_fault(tree) ==
// nullptr.
inline std::vector<PackedNode> packed_nodes(const runtime::PackedSphereTree& tree) {
  std::vector<PackedNode> nodes{{0, 0}};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto [index, lane] = nodes[i];
    const std::uint32_t link = tree.blocks[index].link[lane];
    if ((link & runtime::kLeafBit) != 0) continue;
    const auto [first, count] = runtime::children_of(tree.branching, link);
    for (Index child = 0; child < count; ++child)
      nodes.push_back({first + child / runtime::kBlockWidth, child % runtime::kBlockWidth});
  }
  return nodes;
}

}  // namespace orchard
