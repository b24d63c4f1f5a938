#include "orchard/spheretree/certify.h"

#include "packed_nodes.h"

namespace orchard {

std::vector<PathBall> path_balls(const runtime::PackedSphereTree& tree) {
  const std::vector<PackedNode> nodes = packed_nodes(tree);
  std::vector<PathBall> balls(nodes.size());
  Index next_child = 1;
  for (Index i = 0; i < nodes.size(); ++i) {
    const auto [index, lane] = nodes[i];
    const runtime::SiblingBlock& block = tree.blocks[index];
    balls[i].center = Point(block.x[lane], block.y[lane], block.z[lane]);
    balls[i].radius = block.radius[lane];
    balls[i].leaf = (block.link[lane] & runtime::kLeafBit) != 0;
    if (balls[i].leaf) continue;
    const Index children = runtime::children_of(tree.branching, block.link[lane]).count;
    for (Index child = 0; child < children; ++child) balls[next_child++].parent = i;
  }
  return balls;
}

Coverage certify(const Surface& surface, const runtime::PackedSphereTree& tree, const Progress& progress) {
  const Point origin(tree.origin[0], tree.origin[1], tree.origin[2]);
  return surface_coverage(surface, path_balls(tree), origin, progress);
}

}  // namespace orchard
