#pragma once
#include <array>
#include <vector>

#include "triangle_tree.h"

namespace orchard::detail {

// Builds a TriangleTree top down by the surface-area heuristic. O(n log n).
class TriangleTree::Builder {
 public:
  static constexpr Index kLeaf = 0x80000000u;
  // Room for what a traversal has still to visit: three entries a level, and the tree is below 40 levels.
  static constexpr std::size_t kStackSize = 128;

  Builder(const TriangleMesh& mesh, const Point& center, double scale, std::vector<Node>& nodes,
          std::vector<Leaf>& leaves);
  void run();

 private:
  using Box3f = Eigen::AlignedBox3f;
  struct Range {
    Index begin, end;  // a range of order_
    Index size() const { return end - begin; }
  };
  struct Split {
    int axis = -1;
    int bin = 0;
    float cost = 0;
  };
  Index add_node(Range range, int depth);
  Index add_leaf(Range range);
  Index split(Range range, int depth);
  // A triangle in the order of the tree, with the values that splitting reads next to each other.
  struct Item {
    Box3f box;  // rounded outward
    Eigen::Vector3f center;
    Index triangle;
  };
  Split best_split(Range range, const Box3f& centers) const;
  static int bin_of(const Item& item, int axis, const Box3f& centers);
  Box3f bounds(Range range) const;
  void add_slab(Range range, Node& node, std::size_t lane) const;
  void flatten(Index triangle, Leaf& leaf, int lane) const;

  const TriangleMesh& mesh_;
  const Point& center_;
  double scale_;
  std::vector<Node>& nodes_;
  std::vector<Leaf>& leaves_;
  std::vector<Item> order_;
};

}  // namespace orchard::detail
