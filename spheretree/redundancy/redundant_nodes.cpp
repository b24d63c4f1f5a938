#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

#include "orchard/spheretree/redundancy.h"

namespace orchard {
namespace {

std::vector<Index> siblings_of(const SphereTree& tree, Index node) {
  std::vector<Index> siblings;
  const Index parent = tree.nodes[node].parent;
  if (parent == kNone) return siblings;
  for (Index k = 0; k < tree.nodes[parent].child_count; ++k)
    if (tree.nodes[parent].first_child + k != node) siblings.push_back(tree.nodes[parent].first_child + k);
  return siblings;
}

// Returns the coverers on which the node's part of every triangle can be proven to rest; nullopt if there is no proof.
std::optional<std::vector<Index>> coverers_of(const SphereTree& tree, const Surface& surface, Index node,
                                              const std::vector<Index>& candidates) {
  if (candidates.empty()) return std::nullopt;
  std::vector<PathBall> balls;
  balls.reserve(candidates.size());
  for (Index i : candidates) balls.push_back({tree.nodes[i].sphere.center, tree.nodes[i].sphere.radius, kNone, true});
  std::vector<Index> triangles;
  surface.triangles_near(tree.nodes[node].sphere, triangles);
  std::vector<char> used(candidates.size(), 0);
  for (Index triangle : triangles) {
    const TriangleCover cover = cover_of_triangle(surface.corners(triangle), tree.nodes[node].sphere, balls);
    if (!cover.covered) return std::nullopt;
    for (Index i : cover.coverers) used[i] = 1;
  }
  std::vector<Index> coverers;
  for (Index i = 0; i < candidates.size(); ++i)
    if (used[i]) coverers.push_back(candidates[i]);
  return coverers;
}

}  // namespace

std::vector<RedundantNode> redundant_nodes(const SphereTree& tree, const Surface& surface, Index level, Coverers by) {
  std::vector<Index> nodes;
  for (Index i = 0; i < tree.nodes.size(); ++i)
    if (tree.nodes[i].level == level && tree.nodes[i].parent != kNone) nodes.push_back(i);
  std::vector<std::optional<std::vector<Index>>> found(nodes.size());
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t i) {
    const Index around = by == Coverers::siblings ? nodes[i] : tree.nodes[nodes[i]].parent;
    found[i] = coverers_of(tree, surface, nodes[i], siblings_of(tree, around));
  });
  std::vector<RedundantNode> redundant;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (found[i]) redundant.push_back({nodes[i], std::move(*found[i])});
  return redundant;
}

}  // namespace orchard
