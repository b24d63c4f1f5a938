#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "math/triangle_pair.h"
#include "orchard/runtime/packed_tree.h"

// Functions by which queries read a packed tree. Precondition of all of them: structure_fault() is nullptr for the
// tree.
namespace orchard::runtime::detail {

// Bounds are made larger or smaller by this fraction, because distances under poses that are rigid to kRigidTolerance
// are off by up to 3e-12 of themselves.
inline constexpr double kStretch = 1e-11;

// Returns an upper bound on the distance of two solids, from a pair of their spheres. It also holds for spheres that do
// not meet: the distances of a point between them from both solids add up to at most `errors` plus the gap.
inline double pair_bound(double distance, double radii, double errors, double depths) noexcept {
  const double bound = std::min(errors + std::max(0.0, distance - radii), depths + distance);
  return std::max(0.0, bound) * (1 + kStretch);
}

inline const SiblingBlock& block_of(const TreeView& tree, std::uint32_t node) noexcept {
  return tree.blocks[node / kBlockWidth];
}

// The block of a node of the triangle BVH, and its child.
inline const ObbNodeBlock& slab_block(const TreeView& tree, std::uint32_t node) noexcept {
  return tree.obb_nodes[node / kBlockWidth];
}
inline std::uint32_t slab_child(const TreeView& tree, std::uint32_t node) noexcept {
  return slab_block(tree, node).child[node % kBlockWidth];
}

inline bool is_leaf(const TreeView& tree, std::uint32_t node) noexcept {
  return (block_of(tree, node).link[node % kBlockWidth] & kLeafBit) != 0;
}

inline Vec3 center_of(const TreeView& tree, std::uint32_t node) noexcept {
  const SiblingBlock& block = block_of(tree, node);
  const std::uint32_t lane = node % kBlockWidth;
  return {block.x[lane], block.y[lane], block.z[lane]};
}

// Returns an upper bound on how far a ball slab reaches along a unit vector, from its centre.
inline double reach_along(const ObbNodeBlock& block, std::uint32_t lane, const Vec3& n) noexcept {
  const Vec3 normal = {double{block.nx[lane]}, double{block.ny[lane]}, double{block.nz[lane]}};
  const double radius = double{block.radius[lane]}, cosine = std::fabs(dot(n, normal));
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)) + 1e-5;  // the normal is unit to 1e-6
  return std::min(radius, double{block.height[lane]} * cosine * (1 + 1e-5) + radius * sine);
}

struct Group {  // consecutive nodes: the children of a node, or one leaf
  std::uint32_t first, count;
};

// Returns the group of a node. `bits` is link_bits(tree.branching).
inline Group group_of(const TreeView& tree, int bits, std::uint32_t node) noexcept {
  const std::uint32_t link = block_of(tree, node).link[node % kBlockWidth];
  if (link & kLeafBit) return {node, 1};
  const Children children = linked_children(bits, link);
  return {children.first * kBlockWidth, children.count};
}

inline TrianglePoints points_of(const TreeView& tree, std::uint32_t triangle) noexcept {
  TrianglePoints points{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& vertex = tree.vertices[tree.triangles[triangle][i]];
    points[i] = {vertex[0], vertex[1], vertex[2]};
  }
  return points;
}

// A ball around all triangles of a body, in its frame.
struct Ball {
  Vec3 middle{};
  double radius = 0;
};
inline Ball ball_around(const TreeView& tree) noexcept {
  const ObbNodeBlock& root = tree.obb_nodes[0];
  return {{root.x[0], root.y[0], root.z[0]}, double{root.radius[0]}};
}

// Does the same as index_triangles(), except that the triangles are divided across the coordinate axes, for boxes along
// these, and that there is no table of supports.
void index_for_rays(PackedSphereTree& tree);

}  // namespace orchard::runtime::detail
