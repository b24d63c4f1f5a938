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

// Packed sphere-trees: the memory layout that queries read, and what prepares it.
namespace orchard::runtime {

// The number of nodes or triangles in a block.
inline constexpr std::uint32_t kBlockWidth = 8;
// The bit that marks a leaf in a link, and the last entry in a list of triangles.
inline constexpr std::uint32_t kLeafBit = 0x80000000u;

// The range of a tree: the largest |coordinate| and radius of everything in it, and the largest |coordinate| of its
// origin. Within it, no float of a query overflows; structure_fault(), and so every reader, refuses larger values.
// There is no lower limit: queries are right for every size down to 0.
inline constexpr float kCoordinateLimit = 1e18f;

// Returns how many blocks `children` siblings occupy.
constexpr std::uint32_t block_count(std::uint32_t children) noexcept {
  return children / kBlockWidth + (children % kBlockWidth != 0 ? 1u : 0u);
}

// Eight siblings side by side, so that one vector operation tests them all: 28 bytes a node. Coordinates are relative
// to the tree's origin. A node with more than eight children owns consecutive blocks.
struct alignas(32) SiblingBlock {
  std::array<float, kBlockWidth> x{}, y{}, z{};  // The centre.
  std::array<float, kBlockWidth> radius{};       // Rounded outward; -1 in lanes without a node.
  std::array<float, kBlockWidth> depth{};        // An upper bound on the centre's signed distance, negative inside.
  std::array<float, kBlockWidth> error{};        // An upper bound on the distance to the solid over the closed ball.
  // Inner node: inner_link(). Leaf: kLeafBit and the start of its list.
  std::array<std::uint32_t, kBlockWidth> link{};
};
static_assert(sizeof(SiblingBlock) == 224 && alignof(SiblingBlock) == 32);

struct Children {
  std::uint32_t first, count;  // The block of the first child, and the number of children.
};

// The largest branching. An inner node stores its children in one word without kLeafBit: the lowest link_bits() bits,
// which suffice for the tree's branching, are the number of children less 1, and the other bits the block of the first
// child, at most last_linked_block().
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

// Eight nodes of the triangle BVH side by side. A node is a ball slab: the part of a ball between two parallel planes
// at the same distance from its centre. Every triangle below the node lies in it and in every node above it. Two more
// pairs of planes, perpendicular to the first ones and to each other, make it an oriented box, too; the third pair's
// normal is the cross product of the first and the second one in float.
struct alignas(32) ObbNodeBlock {
  std::array<float, kBlockWidth> x{}, y{}, z{};     // The centre.
  std::array<float, kBlockWidth> nx{}, ny{}, nz{};  // The normal of the planes: unit to 1e-6.
  std::array<float, kBlockWidth> radius{};          // The radius of the ball; -1 in lanes without a node.
  std::array<float, kBlockWidth> height{};          // At least |normal * (point - centre)| of every point.
  // The normal of the second pair: unit and perpendicular to the first, to 1e-6.
  std::array<float, kBlockWidth> mx{}, my{}, mz{};
  std::array<float, kBlockWidth> width{};          // As height, along the second normal.
  std::array<float, kBlockWidth> length{};         // As height, along the third normal.
  std::array<std::uint32_t, kBlockWidth> child{};  // The block of the first child; with kLeafBit, a triangle block.
};
static_assert(sizeof(ObbNodeBlock) == 448 && alignof(ObbNodeBlock) == 32);

// Up to eight triangles side by side, as the exact level reads them.
struct alignas(32) TriangleBlock {
  using Lanes = std::array<float, kBlockWidth>;
  std::array<std::array<Lanes, 3>, 3> corner{};       // [corner][coordinate]; unused lanes repeat the first one.
  std::array<std::uint32_t, kBlockWidth> triangle{};  // Into triangles; kNoTriangle in unused lanes.
};
static_assert(sizeof(TriangleBlock) == 320 && alignof(TriangleBlock) == 32);

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;
inline constexpr std::uint32_t kEmptyLeaf = 0xffffffffu;  // The link of a leaf without triangles.
inline constexpr std::uint32_t kSupportCells = 8;         // Along an edge of the cube of directions.
inline constexpr std::uint32_t kSupportCount = 6 * (kSupportCells + 1) * (kSupportCells + 1);
// The largest number of levels below the root of a triangle BVH.
inline constexpr std::uint32_t kTriangleTreeDepthLimit = 64;

// The numbers of a tree.
struct TreeNumbers {
  std::array<double, 3> origin{};         // The origin of all float coordinates, in mesh units.
  double bounding_radius = 0;             // R of the mesh.
  double vertex_error = 0;                // The largest distance of a stored vertex from that of the mesh.
  std::uint32_t branching = 0;            // The largest number of children.
  std::uint32_t depth = 0;                // Levels below the root.
  std::uint32_t node_count = 0;           // Lanes in use.
  std::uint32_t triangle_tree_depth = 0;  // Levels below the root of the triangle BVH.
};

// A sphere-tree for the run-time: flat arrays of floats around a double origin, with every ball rounded outward. Blocks
// are in breadth-first order; lane 0 of block 0 is the root and the only node of its block. A node's id is block * 8 +
// lane. Every leaf lists the triangles that meet its path region; together the leaves list every triangle.
// The exact level has a triangle BVH of its own over the same triangles, which index_triangles() builds: ball slabs in
// breadth-first order. Lane 0 of block 0 is its root, and every other block contains the children of one node.
struct PackedSphereTree : TreeNumbers {
  std::vector<SiblingBlock> blocks;
  std::vector<std::array<float, 3>> vertices;           // Relative to origin.
  std::vector<std::array<std::uint32_t, 3>> triangles;  // Into vertices.
  std::vector<std::uint32_t> leaf_triangles;            // Into triangles; kLeafBit marks the last one of a leaf.
  std::vector<ObbNodeBlock> obb_nodes;
  std::vector<TriangleBlock> triangle_blocks;
  // The extent of the triangles: the largest direction . point, rounded up, for directions on the surface of the cube
  // of side 2, in the order of support_direction(). There are kSupportCount values if there are triangles, otherwise
  // none.
  std::vector<float> supports;
};

// Returns the direction of element `index` of the supports.
constexpr std::array<double, 3> support_direction(std::uint32_t index) noexcept {
  constexpr std::uint32_t side = kSupportCells + 1;
  const std::uint32_t face = index / (side * side), axis = face / 2;
  std::array<double, 3> direction{};
  direction[axis] = face % 2 == 0 ? 1 : -1;
  direction[(axis + 1) % 3] = 2.0 * (index / side % side) / kSupportCells - 1;
  direction[(axis + 2) % 3] = 2.0 * (index % side) / kSupportCells - 1;
  return direction;
}

// The same data without ownership, which queries use. The arrays may belong to a PackedSphereTree or to a file that is
// mapped into memory; they must outlive the view and not change.
struct TreeView : TreeNumbers {
  std::span<const SiblingBlock> blocks;
  std::span<const std::array<float, 3>> vertices;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const std::uint32_t> leaf_triangles;
  std::span<const ObbNodeBlock> obb_nodes;
  std::span<const TriangleBlock> triangle_blocks;
  std::span<const float> supports;

  TreeView() = default;
  TreeView(const PackedSphereTree& tree) noexcept  // NOLINT: implicit, so that queries take either
      : TreeNumbers(tree),
        blocks(tree.blocks),
        vertices(tree.vertices),
        triangles(tree.triangles),
        leaf_triangles(tree.leaf_triangles),
        obb_nodes(tree.obb_nodes),
        triangle_blocks(tree.triangle_blocks),
        supports(tree.supports) {}
};

// Returns the entries of leaf_triangles that a leaf lists. In the last one, kLeafBit is also set.
std::span<const std::uint32_t> listed_triangles(const TreeView& tree, std::uint32_t link) noexcept;

// Appends the list of a leaf and returns the link to it. Precondition: indices are below kLeafBit. Throws
// std::bad_alloc only.
std::uint32_t add_list(PackedSphereTree& tree, std::span<const std::uint32_t> triangles);

// Builds the triangle BVH and `supports` from `vertices` and `triangles`; call it when these are complete.
// Precondition: indices are in range and coordinates within kCoordinateLimit. Throws std::bad_alloc only. The result is
// deterministic. O(n log n).
void index_triangles(PackedSphereTree& tree);

// Returns what is wrong with the structure of a tree, or nullptr. It checks everything that a query needs to stay
// within the arrays: indices are in range, children come after their parent, no block is shared, coordinates are at
// most kCoordinateLimit and lengths four times that, radii are at least 0, a tree with triangles has a triangle BVH
// that repeats the corners exactly, and blocks are aligned as their types require. `error` and `depth` may be
// +infinity, which means unknown; a bound on separation that needs them is then infinite. Allocates nothing. O(nodes +
// triangles).
const char* structure_fault(const TreeView& tree) noexcept;

// Returns an upper bound on |centre| + radius over the nodes and on |vertex|, relative to the origin. The rounding of a
// query is a multiple of it. O(nodes + vertices).
double coordinate_extent(const TreeView& tree) noexcept;

// Values that every query needs of a tree, computed once per tree and shared by all pairs with this tree, in any number
// of threads. Precondition: structure_fault(tree) is nullptr, and what the view refers to outlives this object
// unchanged. The constructor allocates nothing and throws nothing. O(nodes + triangles), about 0.1 ms for 1000
// triangles.
struct PreparedTree {
  PreparedTree() = default;
  explicit PreparedTree(const TreeView& view) noexcept;

  TreeView tree;
  std::array<double, 3> root{}, middle{};   // The root's centre, with and without the tree's origin.
  double radius = 0, reach = 0, depth = 0;  // Those of the root; `reach` is its error.
  double error = 0;                         // The largest error of a point, for any pose.
  double extent = 0;                        // coordinate_extent().
  int bits = 0;                             // link_bits() of the tree.
  std::uint64_t fingerprint = 0;            // Of everything stored: equal for copies of one tree.
};

// Returns the tree of a point. The functions below return trees of other simple shapes, so that every query between
// trees (contacts, distances, times of impact) works for them, too. A sphere, a capsule or a box with rounded edges is
// a point, a segment or a box with a margin (closer_than(), ImpactOptions::margin). Queries refer to surfaces: for a
// body that may lie wholly inside a box or hull, use touches_box() or touches_convex(). All of these functions throw
// std::bad_alloc only.
PackedSphereTree point_tree(const std::array<double, 3>& point);
PackedSphereTree segment_tree(const std::array<double, 3>& p, const std::array<double, 3>& q);
// Returns the tree of a box around the origin. `half` contains half the edges' lengths, above 0.
PackedSphereTree box_tree(const std::array<double, 3>& half);
// Returns the tree of a few dozen triangles without changing them; the spheres' bounds are unknown. For meshes use
// `orchard build`.
PackedSphereTree triangles_tree(std::span<const std::array<double, 3>> vertices,
                                std::span<const std::array<std::uint32_t, 3>> triangles);
// Returns the tree of the convex hull of points, with triangles oriented outward; its corners are among the given
// points. Exact predicates decide. Returns nullopt if the points lie in a plane or are not finite. O(n h) for h facets.
std::optional<PackedSphereTree> hull_tree(std::span<const std::array<double, 3>> points);

}  // namespace orchard::runtime
