#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// Blocks, and what queries keep, are aligned to 32 bytes. Where clang before 15 compiles C++23, std::vector of GCC's
// library does not respect that, and the first vector instruction would end the program.
#if defined(__clang__) && defined(__GLIBCXX__) && !defined(__apple_build_version__)
#if __clang_major__ < 15 && __cplusplus > 202002L
#error "clang before 15 gives std::vector of GCC's library no alignment as C++23: compile what uses orchard as C++20"
#endif
#endif

namespace orchard::runtime {

inline constexpr std::uint32_t kBlockWidth = 8;
inline constexpr std::uint32_t kLeafBit = 0x80000000u;

// The range of a tree: |coordinate| and radius of everything in it, and |coordinate| of its origin, are at most this.
// No float of a query overflows then; what is larger is refused by structure_fault(), and so by every reader. There is
// no lower end: queries are right for every size down to 0.
inline constexpr float kCoordinateLimit = 1e18f;

// Blocks that `children` siblings take.
constexpr std::uint32_t block_count(std::uint32_t children) noexcept {
  return children / kBlockWidth + (children % kBlockWidth != 0 ? 1u : 0u);
}

// Eight siblings side by side, so that one vector operation tests them all: 28 bytes a node.
// Coordinates are relative to the tree's origin. A node with more than eight children owns consecutive blocks.
struct alignas(32) SiblingBlock {
  std::array<float, kBlockWidth> x{}, y{}, z{};   // centre
  std::array<float, kBlockWidth> radius{};        // rounded outward; -1 in lanes that hold no node
  std::array<float, kBlockWidth> depth{};         // upper bound on the signed distance of the centre, negative inside
  std::array<float, kBlockWidth> error{};         // upper bound on the distance to the solid over the closed ball
  std::array<std::uint32_t, kBlockWidth> link{};  // inner node: inner_link(); leaf: kLeafBit and where its list begins
};
static_assert(sizeof(SiblingBlock) == 224 && alignof(SiblingBlock) == 32);

struct Children {
  std::uint32_t first, count;  // block of the first one; how many there are
};

// An inner node's children in one word without kLeafBit: the lowest link_bits() bits, enough for the tree's branching,
// are the number of children less 1, the others the first one's block, at most last_linked_block(). Branching is at
// most kMaxBranching.
inline constexpr std::uint32_t kMaxBranching = 1u << 30;
constexpr int link_bits(std::uint32_t branching) noexcept {
  return branching > 1 ? static_cast<int>(std::bit_width(branching - 1)) : 0;
}
constexpr std::uint32_t inner_link(std::uint32_t branching, const Children& children) noexcept {
  return children.first << link_bits(branching) | (children.count - 1);
}
constexpr Children linked_children(int bits, std::uint32_t link) noexcept {
  return {link >> bits, (link & ((1u << bits) - 1)) + 1};
}
constexpr Children children_of(std::uint32_t branching, std::uint32_t link) noexcept {
  return linked_children(link_bits(branching), link);
}
constexpr std::uint32_t last_linked_block(std::uint32_t branching) noexcept {
  return (kLeafBit - 1) >> link_bits(branching);
}

// Eight ball slabs side by side: nodes of the tree of triangles below the spheres. A ball slab is the part of a ball
// between two parallel planes, the same distance from its centre; every triangle below the node lies in it, in every
// node above it. With two more pairs of planes, across the first ones and each other, it is also an oriented box: the
// third pair's normal is the first one's times the second one's (cross product in float).
struct alignas(32) ObbNodeBlock {
  std::array<float, kBlockWidth> x{}, y{}, z{};     // centre
  std::array<float, kBlockWidth> nx{}, ny{}, nz{};  // normal of the planes: unit to 1e-6
  std::array<float, kBlockWidth> radius{};          // of the ball; -1 in lanes that hold no node
  std::array<float, kBlockWidth> height{};          // |normal * (point - centre)| of every point is at most this
  std::array<float, kBlockWidth> mx{}, my{}, mz{};  // normal of the second pair: unit, and across the first, to 1e-6
  std::array<float, kBlockWidth> width{};           // as height, along the second normal,
  std::array<float, kBlockWidth> length{};          // and along the third one
  std::array<std::uint32_t, kBlockWidth> child{};   // block of the first child; with kLeafBit set, a triangle block
};
static_assert(sizeof(ObbNodeBlock) == 448 && alignof(ObbNodeBlock) == 32);

// Up to eight triangles side by side, as the exact level reads them.
struct alignas(32) TriangleBlock {
  using Lanes = std::array<float, kBlockWidth>;
  std::array<std::array<Lanes, 3>, 3> corner{};       // [corner][coordinate]; unused lanes repeat the first one
  std::array<std::uint32_t, kBlockWidth> triangle{};  // into triangles; kNoTriangle in unused lanes
};
static_assert(sizeof(TriangleBlock) == 320 && alignof(TriangleBlock) == 32);

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;
inline constexpr std::uint32_t kEmptyLeaf = 0xffffffffu;  // link of a leaf that lists no triangles
inline constexpr std::uint32_t kSupportCells = 8;         // along an edge of the cube of directions
inline constexpr std::uint32_t kSupportCount = 6 * (kSupportCells + 1) * (kSupportCells + 1);
inline constexpr std::uint32_t kTriangleTreeDepthLimit = 64;  // levels below the root that a tree of triangles may have

// A sphere-tree as it ships: flat arrays of floats around a double origin, every ball rounded outward. Blocks are in
// breadth-first order; lane 0 of block 0 is the root and the only node of its block. Node id = block * 8 + lane.
// Every leaf lists the triangles that meet its path region; together the leaves list every triangle.
// The exact level has a tree of its own over the same triangles (index_triangles() makes it): ball slabs in
// breadth-first order, lane 0 of block 0 its root, every other block the children of one node.
struct PackedSphereTree {
  std::array<double, 3> origin{};         // of all float coordinates, in mesh units
  double bounding_radius = 0;             // R of the mesh
  double vertex_error = 0;                // how far a stored vertex may lie from the mesh's own
  std::uint32_t branching = 0;            // largest number of children
  std::uint32_t depth = 0;                // levels below the root
  std::uint32_t node_count = 0;           // lanes in use
  std::uint32_t triangle_tree_depth = 0;  // levels below the root of the tree of triangles
  std::vector<SiblingBlock> blocks;
  std::vector<std::array<float, 3>> vertices;           // relative to origin
  std::vector<std::array<std::uint32_t, 3>> triangles;  // into vertices
  std::vector<std::uint32_t> leaf_triangles;            // into triangles; kLeafBit marks the last one of a leaf
  std::vector<ObbNodeBlock> obb_nodes;
  std::vector<TriangleBlock> triangle_blocks;
  // How far the triangles reach: the largest of direction . point, rounded up, for directions on the surface of the
  // cube of side 2, in the order of support_direction(). kSupportCount of them if there are triangles, or none.
  std::vector<float> supports;
};

constexpr std::array<double, 3> support_direction(std::uint32_t index) noexcept {
  constexpr std::uint32_t side = kSupportCells + 1;
  const std::uint32_t face = index / (side * side), axis = face / 2;
  std::array<double, 3> direction{};
  direction[axis] = face % 2 == 0 ? 1 : -1;
  direction[(axis + 1) % 3] = 2.0 * (index / side % side) / kSupportCells - 1;
  direction[(axis + 2) % 3] = 2.0 * (index % side) / kSupportCells - 1;
  return direction;
}

// The same without owning the arrays: what queries work on. The arrays may belong to a PackedSphereTree or to a file
// that is mapped into memory; they must outlive the view and stay unchanged.
struct TreeView {
  std::array<double, 3> origin{};
  double bounding_radius = 0, vertex_error = 0;
  std::uint32_t branching = 0, depth = 0, node_count = 0, triangle_tree_depth = 0;
  std::span<const SiblingBlock> blocks;
  std::span<const std::array<float, 3>> vertices;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const std::uint32_t> leaf_triangles;
  std::span<const ObbNodeBlock> obb_nodes;
  std::span<const TriangleBlock> triangle_blocks;
  std::span<const float> supports;

  TreeView() = default;
  TreeView(const PackedSphereTree& tree) noexcept  // NOLINT: implicit, so that queries take either
      : origin(tree.origin),
        bounding_radius(tree.bounding_radius),
        vertex_error(tree.vertex_error),
        branching(tree.branching),
        depth(tree.depth),
        node_count(tree.node_count),
        triangle_tree_depth(tree.triangle_tree_depth),
        blocks(tree.blocks),
        vertices(tree.vertices),
        triangles(tree.triangles),
        leaf_triangles(tree.leaf_triangles),
        obb_nodes(tree.obb_nodes),
        triangle_blocks(tree.triangle_blocks),
        supports(tree.supports) {}
};

// The entries of leaf_triangles that a leaf lists; the last one has kLeafBit set besides.
std::span<const std::uint32_t> listed_triangles(const TreeView& tree, std::uint32_t link) noexcept;

// Appends a leaf's list and returns the link to it. Precondition: indices below kLeafBit. Throws std::bad_alloc only.
std::uint32_t add_list(PackedSphereTree& tree, std::span<const std::uint32_t> triangles);

// Builds the tree of triangles, and `supports`, from `vertices` and `triangles`: to be called once these are complete.
// Deterministic. Throws std::bad_alloc only. O(n log n). Precondition: indices are in range and coordinates within
// kCoordinateLimit.
void index_triangles(PackedSphereTree& tree);

// What is wrong with a tree's structure, or nullptr: indices in range, children after their parent, no block shared,
// coordinates up to kCoordinateLimit, lengths four times that, radii >= 0, a tree of triangles if there are triangles,
// of which it repeats the corners exactly, blocks at addresses that their types allow. Everything a query relies on to
// stay in bounds. `error` and `depth` may be +infinity: unknown, and then a bound on separation that needs them is
// infinite. O(nodes + triangles), allocates nothing.
const char* structure_fault(const TreeView& tree) noexcept;

// Upper bound on |centre| + radius over the nodes and on |vertex|, relative to the origin: the rounding of a query is a
// multiple of it. O(nodes + vertices).
double coordinate_extent(const TreeView& tree) noexcept;

// What every query needs to know of a tree and would otherwise have to work out again. It is made once per tree and
// shared by all pairs that the tree is part of, in any number of threads. O(nodes + triangles), some 0.1 ms for 1000
// triangles; allocates nothing and throws nothing. Precondition: structure_fault(tree) is nullptr, and what the view
// refers to outlives this object unchanged.
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

// Trees of simple shapes, so that every query between trees answers about them, too: contacts, distances, times of
// impact. All of them throw std::bad_alloc only. A sphere, a capsule or a box with rounded edges is a point, a segment
// or a box asked about with a margin (closer_than(), ImpactOptions::margin).
// Queries are about surfaces: for a body that may lie wholly inside a box or hull ask touches_box(), touches_hull().

PackedSphereTree point_tree(const std::array<double, 3>& point);
PackedSphereTree segment_tree(const std::array<double, 3>& p, const std::array<double, 3>& q);
// Centred at the origin; half the edges' lengths, positive.
PackedSphereTree box_tree(const std::array<double, 3>& half);
// Of triangles as they are, the spheres' bounds unknown: for a few dozen triangles. For meshes there is `orchard
// build`.
PackedSphereTree triangles_tree(std::span<const std::array<double, 3>> vertices,
                                std::span<const std::array<std::uint32_t, 3>> triangles);
// The convex hull of points, with triangles outward; corners are points of those given. Nothing if they lie in a plane,
// or are not finite. Exact predicates decide; O(n h) for h facets.
std::optional<PackedSphereTree> hull_tree(std::span<const std::array<double, 3>> points);

}  // namespace orchard::runtime
