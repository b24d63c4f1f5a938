#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/runtime/packed_tree.h"

// Trees of flexible bodies (dissertation 8.2).
namespace orchard::runtime {

// A tree whose triangles move a little about a rest position. The spheres and the triangle BVH follow, and stay
// certified: a point of a triangle moves no farther than the triangle's corners, so a ball that contained it at rest
// contains it if it is enlarged by that distance. A node is enlarged by the largest displacement from *rest* among the
// triangles listed below it, so that it shrinks again when they come back, and enlargements do not accumulate.
//
//   FlexibleTree cloth(tree, 0.1);                     // no vertex moves farther than 0.1 from where it is in `tree`
//   const ShapeId shape = world.add_shape(cloth.view());
//   cloth.move(vertices, places);                      // between two steps
//   world.shape_changed(shape);
//
// Queries between two moves see the same tree; no query may run during a move. Only the constructor throws,
// std::bad_alloc.
class FlexibleTree {
 public:
  // Copies a tree at rest. `max_displacement` is the largest distance, in mesh units, that a vertex may move from its
  // place at rest. Bounds on the distance to the solid (`error`, `depth`), the table of supports and the root are
  // enlarged once, for this displacement. Precondition: structure_fault(rest) is nullptr. O(nodes + triangles).
  FlexibleTree(const PackedSphereTree& rest, double max_displacement);

  // Returns false if the displacement is negative or not finite, or if coordinates might leave kCoordinateLimit. The
  // tree then never moves.
  bool valid() const noexcept { return valid_; }
  TreeView view() const noexcept { return tree_; }

  // Moves vertices[i] (an index into the tree's vertices) to places[i], in the coordinates of the mesh. Returns false
  // and changes nothing if an index is out of range, or a place is not finite or farther than max_displacement from
  // where the vertex rests. Takes O(triangles at these vertices, and nodes above them), which nodes_touched() counts.
  bool move(std::span<const std::uint32_t> vertices, std::span<const std::array<double, 3>> places) noexcept;

  std::size_t nodes_touched() const noexcept { return touched_; }  // By the last move, in both trees.
  std::size_t nodes() const noexcept { return spheres_.size() + obb_nodes_.size(); }
  // Returns by how much the leaves are larger than at rest: the sum of their enlargements over the sum of their radii.
  double looseness() const noexcept { return rest_radii_ > 0 ? enlarged_ / rest_radii_ : 0; }
  // Returns whether queries cost several times as much as with a tree that is built for the present shape.
  bool worth_rebuilding() const noexcept { return looseness() > 0.5; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Node {
    std::uint32_t parent = kNone;
    std::uint32_t level = 0;
    float radius = 0;              // at rest, as
    std::array<float, 3> sides{};  // height, width and length of a ball slab
    double enlarged = 0;
    bool used = false, dirty = false;
  };
  struct Lists {  // of numbers, one after the other
    std::vector<std::uint32_t> begin, items;
    std::span<const std::uint32_t> of(std::uint32_t i) const noexcept {
      return std::span(items).subspan(begin[i], begin[i + 1] - begin[i]);
    }
  };
  using Levels = std::vector<std::vector<std::uint32_t>>;
  struct Dirty {            // What has to follow the triangles that moved; there is room for all of it.
    Levels spheres, slabs;  // Nodes by level.
    std::vector<std::uint32_t> blocks;
    std::vector<std::uint8_t> is_dirty;  // By block.
  };

  static void adopt(std::vector<Node>& nodes, std::uint32_t parent, std::uint32_t child) noexcept;
  static Levels room_by_level(const std::vector<Node>& nodes);
  void link_spheres();
  void link_obb_nodes();
  void list_triangles();
  void enlarge_for_good();
  void mark(std::vector<Node>& nodes, Levels& levels, std::uint32_t node) noexcept;
  void rewrite(std::uint32_t block) noexcept;
  template <typename EnlargedBy, typename Write>
  void refit(std::vector<Node>& nodes, Levels& dirty, const EnlargedBy& enlarged_by, const Write& write) noexcept;
  void refit_spheres() noexcept;
  void refit_obb_nodes() noexcept;
  double max_of_leaf(std::uint32_t link) const noexcept;
  double max_of_block(std::uint32_t block) const noexcept;

  PackedSphereTree tree_;
  double largest_;
  bool valid_ = false;
  std::vector<std::array<float, 3>> rest_;
  std::vector<double> moved_;              // by triangle: how far its corners are from rest, at most
  std::vector<Node> spheres_, obb_nodes_;  // by node
  Lists triangles_of_vertex_, leaves_of_triangle_;
  std::vector<std::uint32_t> block_of_triangle_, slab_of_block_;
  Dirty dirty_;
  double enlarged_ = 0, rest_radii_ = 0;
  std::size_t touched_ = 0;
};

}  // namespace orchard::runtime
