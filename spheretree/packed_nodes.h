#pragma once
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard {

struct PackedNode {
  Index block, lane;
};

// Where the nodes of a packed tree are, in breadth-first order. Precondition: structure_fault(tree) == nullptr.
inline std::vector<PackedNode> packed_nodes(const runtime::PackedSphereTree& tree) {
  std::vector<PackedNode> nodes{{0, 0}};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto [index, lane] = nodes[i];
    const runtime::SiblingBlock& block = tree.blocks[index];
    if ((block.count[lane] & runtime::kLeafBit) != 0) continue;
    for (Index child = 0; child < block.count[lane]; ++child)
      nodes.push_back({block.first[lane] + child / runtime::kBlockWidth, child % runtime::kBlockWidth});
  }
  return nodes;
}

}  // namespace orchard
