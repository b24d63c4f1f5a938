#include "orchard/spheretree/certify.h"

namespace orchard {

std::vector<PathBall> path_balls(const runtime::PackedSphereTree& tree) {
  // Breadth-first over the blocks: the root's lane first, then each inner node's children.
  struct Place {
    Index block, lane, parent;
  };
  std::vector<PathBall> balls;
  std::vector<Place> places{{0, 0, kNone}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [block_index, lane, parent] = places[i];
    const runtime::SiblingBlock& block = tree.blocks[block_index];
    const bool leaf = (block.count[lane] & runtime::kLeafBit) != 0;
    balls.push_back({Point(block.x[lane], block.y[lane], block.z[lane]), block.radius[lane], parent, leaf});
    if (leaf) continue;
    for (Index child = 0; child < block.count[lane]; ++child)
      places.push_back(
          {block.first[lane] + child / runtime::kBlockWidth, child % runtime::kBlockWidth, static_cast<Index>(i)});
  }
  return balls;
}

Coverage certify(const Surface& surface, const runtime::PackedSphereTree& tree, const Progress& progress) {
  const Point origin(tree.origin[0], tree.origin[1], tree.origin[2]);
  return surface_coverage(surface, path_balls(tree), progress, origin);
}

}  // namespace orchard
