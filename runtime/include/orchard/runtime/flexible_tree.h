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
  // where the vertex rests. O(nodes + triangles): about 10 ns for each triangle of the tree, and as much again for each
  // that moves.
  bool move(std::span<const std::uint32_t> vertices, std::span<const std::array<double, 3>> places) noexcept;

  // Returns by how much the leaves are larger than at rest: the sum of their enlargements over the sum of their radii.
  // O(nodes).
  double looseness() const noexcept;
  // Returns whether queries cost several times as much as with a tree that is built for the present shape.
  bool worth_rebuilding() const noexcept { return looseness() > 0.5; }

 private:
  void enlarge_permanently();
  void copy_changed_corners(TriangleBlock& block) const noexcept;
  double growth_of(std::uint32_t triangle) const noexcept;
  void refit_obb_nodes() noexcept;
  void refit_spheres() noexcept;

  PackedSphereTree tree_, rest_;
  double largest_;
  bool valid_ = false;
  std::vector<double> moved_;                              // By vertex: how far it is from rest.
  std::vector<std::uint8_t> changed_;                      // By vertex: whether the present call moves it.
  std::vector<double> spheres_growth_, obb_nodes_growth_;  // By node: how far its triangles are from rest, at most.
};

}  // namespace orchard::runtime
