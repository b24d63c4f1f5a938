#pragma once
#include <vector>

#include "orchard/geometry/surface.h"
#include "tangent_touch.h"

namespace orchard::detail {

// A binary tree over the triangles of a surface. Each node has a ball around its triangles and a slab between two
// parallel planes, which is thin where the triangles are nearly coplanar. A ball that touches a finely meshed surface
// from inside therefore does not have to visit all triangles near it.
class SlabTree {
 public:
  struct Node {
    Point center = Point::Zero();
    double radius = 0;
    Vector normal = Vector::Zero();  // the slab is low <= normal x <= high
    double low = 0, high = 0;
    Index first = 0, count = 0;  // of a leaf: its items in triangles(); count is 0 in inner nodes
    Index children = 0;          // the numbers of the two children are this and the next one
  };

  explicit SlabTree(const Surface& surface);

  const std::vector<Node>& nodes() const { return nodes_; }  // the root first
  std::span<const Index> triangles(const Node& leaf) const {
    return std::span(triangles_).subspan(leaf.first, leaf.count);
  }

  // Returns a lower bound on the radius of the balls that touch a triangle below the node; infinity if no triangle is
  // in the cone.
  static double min_touch(const Node& node, const TangentPlace& place);
  // The same bound for ray_through_triangle().
  static double min_ray(const Node& node, const TangentPlace& place);

 private:
  static double max_depth(const Node& node, const TangentPlace& place, const Vector& way);
  void fill(Index node, Index begin, Index end);
  void bound(Node& node, Index begin, Index end) const;

  const Surface& surface_;
  std::vector<Point> middles_;  // of triangles, while the tree is built
  std::vector<Index> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace orchard::detail
