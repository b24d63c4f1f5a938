#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace orchard::runtime {

inline constexpr std::uint32_t kBlockWidth = 8;
inline constexpr std::uint32_t kLeafBit = 0x80000000u;
inline constexpr float kCoordinateLimit =
    1e18f;  // largest |coordinate| and radius: squared distances stay finite in float

// Blocks that `children` siblings take.
constexpr std::uint32_t block_count(std::uint32_t children) noexcept {
  return children / kBlockWidth + (children % kBlockWidth != 0 ? 1u : 0u);
}

// Eight siblings side by side, so that one vector operation tests them all: 32 bytes a node.
// Coordinates are relative to the tree's origin. A node with more than eight children owns consecutive blocks.
struct alignas(32) SiblingBlock {
  std::array<float, kBlockWidth> x{}, y{}, z{};    // centre
  std::array<float, kBlockWidth> radius{};         // rounded outward; -1 in lanes that hold no node
  std::array<float, kBlockWidth> depth{};          // upper bound on the signed distance of the centre, negative inside
  std::array<float, kBlockWidth> error{};          // upper bound on the distance to the solid over the closed ball
  std::array<std::uint32_t, kBlockWidth> first{};  // inner node: block of its first child; leaf: into leaf_triangles
  std::array<std::uint32_t, kBlockWidth> count{};  // inner node: children; leaf: triangles, with kLeafBit set
};
static_assert(sizeof(SiblingBlock) == 256 && alignof(SiblingBlock) == 32);

// A sphere-tree as it ships: flat arrays of floats around a double origin, every ball rounded outward. Blocks are in
// breadth-first order; lane 0 of block 0 is the root and the only node of its block. Node id = block * 8 + lane.
// Every leaf lists the triangles that meet its path region; together the leaves list every triangle.
struct PackedSphereTree {
  std::array<double, 3> origin{};  // of all float coordinates, in mesh units
  double bounding_radius = 0;      // R of the mesh
  double vertex_error = 0;         // how far a stored vertex may lie from the mesh's own
  std::uint32_t branching = 0;     // largest number of children
  std::uint32_t depth = 0;         // levels below the root
  std::uint32_t node_count = 0;    // lanes in use
  std::vector<SiblingBlock> blocks;
  std::vector<std::array<float, 3>> vertices;           // relative to origin
  std::vector<std::array<std::uint32_t, 3>> triangles;  // into vertices
  std::vector<std::uint32_t> leaf_triangles;            // into triangles
};

// What is wrong with a tree's structure, or nullptr: indices in range, children after their parent, no block shared,
// finite coordinates up to kCoordinateLimit, radii >= 0. Everything a query relies on to stay in bounds. `error` and
// `depth` may be +infinity (unknown). O(nodes + triangles), allocates nothing.
const char* structure_fault(const PackedSphereTree& tree) noexcept;

// Upper bound on |centre| + radius over the nodes and on |vertex|, relative to the origin: the rounding of a query is a
// multiple of it. O(nodes + vertices).
double coordinate_extent(const PackedSphereTree& tree) noexcept;

}  // namespace orchard::runtime
