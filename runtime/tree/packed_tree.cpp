#include "orchard/runtime/packed_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "orchard/runtime/pose.h"

namespace orchard::runtime {
namespace {

constexpr double kNormalTolerance = 1e-6;  // for products of a ball slab's normals, which are rounded to float

// Comparisons are written so that a NaN fails them.
bool in_range(float value) noexcept { return std::fabs(value) <= kCoordinateLimit; }

// Returns whether a length is in the range of sums of three coordinates and of distances between points.
bool is_length(double value) noexcept { return value >= 0 && value <= 4 * double{kCoordinateLimit}; }

const char* node_fault(const SiblingBlock& block, std::uint32_t lane) noexcept {
  if (!(in_range(block.x[lane]) && in_range(block.y[lane]) && in_range(block.z[lane]))) {
    return "a node's centre is not finite or out of range";
  }
  if (!(block.radius[lane] >= 0 && in_range(block.radius[lane]))) return "a node's radius is negative or out of range";
  if (!(block.error[lane] >= 0)) return "a node's error bound is negative or not a number";
  if (!(block.depth[lane] >= -kCoordinateLimit)) return "a node's depth is not a number or out of range";
  return nullptr;
}

// Returns how many lanes hold a node: those before the first empty one. All lanes behind it must be marked empty, too;
// otherwise the result is larger than kBlockWidth.
template <typename Block>
std::uint32_t used_lanes(const Block& block) noexcept {
  const auto first = std::find(block.radius.begin(), block.radius.end(), -1.0f);
  const bool rest_is_empty = std::all_of(first, block.radius.end(), [](float radius) { return radius == -1; });
  return rest_is_empty ? static_cast<std::uint32_t>(first - block.radius.begin()) : kBlockWidth + 1;
}

// Walks the blocks of a tree. In breadth-first order the children of the nodes seen so far occupy exactly the blocks up
// to next_block, so one counter proves that no block is shared, skipped or its own ancestor. node_fault(block, lane,
// next_block) checks a node and counts the blocks of its children.
template <typename Block, typename NodeFault>
const char* order_fault(std::span<const Block> blocks, std::uint32_t depth, const NodeFault& node_fault) noexcept {
  if (blocks.size() > kNoTriangle / kBlockWidth) return "there are too many blocks for 32-bit node ids";
  if (used_lanes(blocks[0]) != 1) return "the root is not the only node of its block";
  std::size_t next_block = 1, level_end = 1;
  std::uint32_t level = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (b == next_block) return "a block has no parent";
    if (b == level_end) level_end = next_block, ++level;
    const std::uint32_t used = used_lanes(blocks[b]);
    if (used == 0 || used > kBlockWidth) return "a block is empty, or a lane beyond its last node is not marked empty";
    for (std::uint32_t lane = 0; lane < used; ++lane) {
      if (const char* fault = node_fault(blocks[b], lane, next_block)) return fault;
    }
    if (next_block > blocks.size()) return "a node's children are beyond the end";
  }
  return level == depth ? nullptr : "the depth does not match the nodes";
}

const char* sphere_tree_fault(const TreeView& tree) noexcept {
  if (tree.blocks.empty()) return "there is no root";
  std::uint64_t nodes = 0;
  const auto fault = order_fault(
      tree.blocks, tree.depth, [&](const SiblingBlock& block, std::uint32_t lane, std::size_t& next) -> const char* {
        ++nodes;
        if (const char* wrong = node_fault(block, lane)) return wrong;
        if (block.link[lane] & kLeafBit) {
          const bool listed = (block.link[lane] & ~kLeafBit) < tree.leaf_triangles.size();
          return listed || block.link[lane] == kEmptyLeaf ? nullptr : "a leaf lists triangles beyond the end";
        }
        if (tree.branching == 0 || tree.branching > kMaxBranching) return "the branching is out of range";
        const auto [first, count] = children_of(tree.branching, block.link[lane]);
        if (count > tree.branching) return "an inner node has more children than the branching";
        if (first != next) return "blocks are not in breadth-first order";
        next += block_count(count);
        if (next > tree.blocks.size()) return "a node's children are beyond the end";
        for (std::uint32_t left = count; left > 0; left -= std::min(left, kBlockWidth)) {
          if (used_lanes(tree.blocks[next - block_count(left)]) != std::min(left, kBlockWidth)) {
            return "the number of a node's children does not match their blocks";
          }
        }
        return nullptr;
      });
  return fault != nullptr || nodes == tree.node_count ? fault : "the node count does not match the nodes";
}

const char* triangle_fault(const TreeView& tree) noexcept {
  for (const auto& vertex : tree.vertices) {
    if (!(in_range(vertex[0]) && in_range(vertex[1]) && in_range(vertex[2]))) {
      return "a vertex is not finite or out of range";
    }
  }
  for (const auto& triangle : tree.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= tree.vertices.size()) return "a triangle names a vertex that does not exist";
    }
  }
  if (tree.triangles.size() > kLeafBit) return "there are too many triangles";
  for (const std::uint32_t triangle : tree.leaf_triangles) {
    if ((triangle & ~kLeafBit) >= tree.triangles.size()) return "a leaf names a triangle that does not exist";
  }
  if (!tree.leaf_triangles.empty() && (tree.leaf_triangles.back() & kLeafBit) == 0) {
    return "the last leaf's list does not end";
  }
  return nullptr;
}

const char* obb_node_fault(const ObbNodeBlock& block, std::uint32_t lane) noexcept {
  for (const auto* values : {&block.x, &block.y, &block.z, &block.radius, &block.height, &block.width, &block.length}) {
    if (!in_range((*values)[lane])) return "a ball slab is not finite or out of range";
  }
  for (const auto* sizes : {&block.radius, &block.height, &block.width, &block.length}) {
    if (!((*sizes)[lane] >= 0)) return "a ball slab has a negative size";
  }
  const Vec3 n(block.nx[lane], block.ny[lane], block.nz[lane]), m(block.mx[lane], block.my[lane], block.mz[lane]);
  if (!(std::fabs(dot(n, n) - 1) <= kNormalTolerance && std::fabs(dot(m, m) - 1) <= kNormalTolerance)) {
    return "a ball slab's normal is not a unit vector";
  }
  return std::fabs(dot(n, m)) <= kNormalTolerance ? nullptr : "a ball slab's normals are not at right angles";
}

const char* triangle_block_fault(const TreeView& tree, const TriangleBlock& block) noexcept {
  if (block.triangle[0] >= tree.triangles.size()) return "a block of triangles is empty or names one beyond the end";
  for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
    const bool used = block.triangle[lane] != kNoTriangle;
    const std::uint32_t index = block.triangle[used ? lane : 0];
    if (index >= tree.triangles.size()) return "a block of triangles names one beyond the end";
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& vertex = tree.vertices[tree.triangles[index][k]];
      for (std::size_t i = 0; i < 3; ++i) {
        if (block.corner[k][i][lane] != vertex[i]) return "a block of triangles differs from the triangles";
      }
    }
  }
  return nullptr;
}

const char* triangle_tree_fault(const TreeView& tree) noexcept {
  if (tree.triangles.empty())
    return tree.obb_nodes.empty() && tree.triangle_blocks.empty() ? nullptr : "ball slabs of nothing";
  if (tree.obb_nodes.empty()) return "the triangles have no tree: build the file again";
  if (tree.triangle_blocks.size() >= kLeafBit || tree.triangle_tree_depth > kTriangleTreeDepthLimit) {
    return "there are too many ball slabs";
  }
  // The child of each node is the next block, of ball slabs or of triangles, that has no parent yet.
  std::size_t next_triangles = 0;
  const auto fault = order_fault(
      tree.obb_nodes, tree.triangle_tree_depth,
      [&](const ObbNodeBlock& block, std::uint32_t lane, std::size_t& next_slabs) {
        if (const char* wrong = obb_node_fault(block, lane)) return wrong;
        std::size_t& next = block.child[lane] & kLeafBit ? next_triangles : next_slabs;
        return (block.child[lane] & ~kLeafBit) == next++ ? nullptr : "ball slabs are not in breadth-first order";
      });
  if (fault != nullptr) return fault;
  if (next_triangles != tree.triangle_blocks.size()) return "a ball slab's children are beyond the end";
  std::size_t triangles = 0;
  for (const TriangleBlock& block : tree.triangle_blocks) {
    if (const char* wrong = triangle_block_fault(tree, block)) return wrong;
    for (const std::uint32_t t : block.triangle) triangles += t != kNoTriangle;
  }
  return triangles == tree.triangles.size() ? nullptr : "the tree of triangles does not hold every triangle once";
}

const char* support_fault(const TreeView& tree) noexcept {
  if (tree.supports.size() != (tree.triangles.empty() ? 0 : kSupportCount)) return "the number of supports is wrong";
  for (const float support : tree.supports) {
    if (!is_length(std::fabs(double{support}))) return "a support is not finite or out of range";
  }
  return nullptr;
}

template <typename Block>
bool is_aligned(std::span<const Block> blocks) noexcept {
  return reinterpret_cast<std::uintptr_t>(blocks.data()) % alignof(Block) == 0;
}

}  // namespace

const char* structure_fault(const TreeView& tree) noexcept {
  // The memory of the blocks may not be aligned: a file may have been read to any place, and a std::vector may ignore
  // the alignment of its elements.
  if (!is_aligned(tree.blocks) || !is_aligned(tree.obb_nodes) || !is_aligned(tree.triangle_blocks))
    return "blocks do not lie at multiples of 32 bytes in memory";
  for (const double coordinate : tree.origin) {
    if (!(std::fabs(coordinate) <= double{kCoordinateLimit})) return "the origin is not finite or out of range";
  }
  if (!is_length(tree.bounding_radius)) return "the bounding radius is negative or out of range";
  if (!is_length(tree.vertex_error)) return "the vertex error is negative or out of range";
  if (const char* fault = triangle_fault(tree)) return fault;
  if (const char* fault = triangle_tree_fault(tree)) return fault;
  if (const char* fault = support_fault(tree)) return fault;
  return sphere_tree_fault(tree);
}

std::span<const std::uint32_t> listed_triangles(const TreeView& tree, std::uint32_t link) noexcept {
  if (link == kEmptyLeaf) return {};
  const std::uint32_t begin = link & ~kLeafBit;
  std::uint32_t end = begin;
  while ((tree.leaf_triangles[end] & kLeafBit) == 0) ++end;
  return tree.leaf_triangles.subspan(begin, end + 1 - begin);
}

std::uint32_t add_list(PackedSphereTree& tree, std::span<const std::uint32_t> triangles) {
  if (triangles.empty()) return kEmptyLeaf;
  const std::uint32_t link = kLeafBit | static_cast<std::uint32_t>(tree.leaf_triangles.size());
  tree.leaf_triangles.insert(tree.leaf_triangles.end(), triangles.begin(), triangles.end());
  tree.leaf_triangles.back() |= kLeafBit;
  return link;
}

double coordinate_extent(const TreeView& tree) noexcept {
  double extent = 0;
  const auto include = [&extent](double x, double y, double z, double radius) {
    // The factor covers the rounding of the five operations before it.
    extent = std::max(extent, (length({x, y, z}) + radius) * (1 + 1e-15));
  };
  const auto include_nodes = [&include](const auto& blocks) {
    for (const auto& block : blocks) {
      for (std::uint32_t lane = 0; lane < kBlockWidth && block.radius[lane] >= 0; ++lane) {
        include(block.x[lane], block.y[lane], block.z[lane], block.radius[lane]);
      }
    }
  };
  include_nodes(tree.blocks), include_nodes(tree.obb_nodes);
  for (const auto& vertex : tree.vertices) include(vertex[0], vertex[1], vertex[2], 0);
  return extent;
}

}  // namespace orchard::runtime
