#pragma once
#include <array>
#include <vector>

#include "orchard/geometry/surface.h"
#include "tangent_touch.h"

namespace orchard::detail {

// A tree over the triangles of a surface with four children to a node. Around each child is a ball, and a slab between
// two parallel planes that is thin where the child's triangles are nearly coplanar. Where the two meet is a flat disc.
// A ball that touches a finely meshed surface from inside therefore does not have to visit all triangles near it.
class SlabTree {
 public:
  static constexpr int kWidth = 4;
  // One number or one vector for each child.
  using Lanes = Eigen::Array<double, kWidth, 1>;
  using Vectors = Eigen::Array<double, kWidth, 3>;

  struct Node {
    Vectors center = Vectors::Zero(), normal = Vectors::Zero();
    Lanes radius = Lanes::Zero();
    // The slab is low <= normal (x - center) <= high.
    Lanes low = Lanes::Zero(), high = Lanes::Zero();
    // A lower bound on the cosine of the angle between the child's normal and those of its triangles.
    Lanes spread = Lanes::Zero();
    std::array<Index, kWidth> children{};  // nodes; of a leaf, triangles
    Index count = 0;                       // of children
    bool is_leaf = false;
  };

  // What a search still looks for: something that a ball with a smaller radius touches, at a triangle whose normal has
  // at most this component along the place's normal.
  struct Limits {
    double radius = 0, cosine = 1;
  };

  explicit SlabTree(const Surface& surface);

  const std::vector<Node>& nodes() const { return nodes_; }  // the root first

  // Returns, for each child, a lower bound on the radius of the balls that touch one of its triangles; infinity if none
  // of them is within the limits and in the cone.
  static Lanes min_touch(const Node& node, const TangentPlace& place, const Limits& limits);
  // The same bounds for ray_through_triangle().
  static Lanes min_ray(const Node& node, const TangentPlace& place, const Limits& limits);

 private:
  Index fill(Index begin, Index end);
  void halve(Index begin, Index middle, Index end);
  void bound(Node& node, Index child, Index begin, Index end) const;

  const Surface& surface_;
  std::vector<Point> middles_;  // of triangles, while the tree is built
  std::vector<Index> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace orchard::detail
