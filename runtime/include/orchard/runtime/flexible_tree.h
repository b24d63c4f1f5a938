#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime {

// A tree whose triangles move a little about a rest position: a flexible body (dissertation 8.2). The spheres and the
// tree of triangles follow, and stay certified:
// a point of a triangle moves no farther than the triangle's corners have, so a ball that held it at rest holds it when
// it is enlarged by that; a node is enlarged by what moved farthest among the triangles listed below it, from where
// they were *at rest*, so that what comes back shrinks again and nothing piles up.
//
//   FlexibleTree cloth(tree, 0.1);                     // no vertex moves farther than 0.1 from where it is in `tree`
//   const ShapeId shape = world.add_shape(cloth.view());
//   cloth.move(vertices, places);                      // between two steps
//   world.shape_changed(shape);
//
// Queries between two moves see one and the same tree; none may be under way during a move. Throws std::bad_alloc from
// the constructor only.
class FlexibleTree {
 public:
  // Precondition: structure_fault(rest) is nullptr. O(nodes + triangles). Bounds on the distance to the solid (`error`,
  // `depth`) and the table of supports are enlarged once, by what `max_displacement` allows, and so is the root.
  FlexibleTree(const PackedSphereTree& rest, double max_displacement);

  // False: the displacement is negative or not finite, or coordinates might leave kCoordinateLimit. It then never
  // moves.
  bool valid() const noexcept { return valid_; }
  TreeView view() const noexcept { return tree_; }

  // Moves vertices[i] (an index into the tree's vertices) to places[i], in the mesh's coordinates. False, and nothing
  // is changed, if an index is out of range, a place is not finite or is farther than max_displacement from where
  // the vertex rests. O(triangles at these vertices, and nodes above them): nodes_touched() says how many.
  bool move(std::span<const std::uint32_t> vertices, std::span<const std::array<double, 3>> places) noexcept;

  std::size_t nodes_touched() const noexcept { return touched_; }  // by the last move, of both trees
  std::size_t nodes() const noexcept { return spheres_.size() + obb_nodes_.size(); }
  // By how much the leaves are larger than at rest: the sum of what they were enlarged by over the sum of their radii.
  double looseness() const noexcept { return rest_radii_ > 0 ? enlarged_ / rest_radii_ : 0; }
  // Beyond this, queries cost several times as much as with a tree built for the present shape.
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
  using Levels = std::vector<std::vector<std::uint32_t>>;  // dirty nodes by level; room for all of them

  static void adopt(std::vector<Node>& nodes, std::uint32_t parent, std::uint32_t child) noexcept;
  static Levels room_by_level(const std::vector<Node>& nodes);
  void link_spheres();
  void link_obb_nodes();
  void list_triangles();
  void enlarge_for_good();
  void mark(std::vector<Node>& nodes, Levels& levels, std::uint32_t node) noexcept;
  void rewrite(std::uint32_t block) noexcept;
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
  Levels dirty_spheres_, dirty_slabs_;
  std::vector<std::uint32_t> dirty_blocks_;
  std::vector<std::uint8_t> block_dirty_;
  double enlarged_ = 0, rest_radii_ = 0;
  std::size_t touched_ = 0;
};

}  // namespace orchard::runtime
