#pragma once
#include <Eigen/Core>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// A bounding volume hierarchy over families of balls, each interpolated linearly on up to three: triangles of points in
// four dimensions, centre and radius. Nodes are boxes there, along the axes of what they hold.
//
// For a unit vector u, |q - c| - r is at least u * q - (u, 1) * (c, r), and (u, 1) * (c, r) is at most what it is at
// the middle of a box and what the box's half axes add. With u from the middle to q they add next to nothing where
// balls touch a surface near q: along a medial sheet the radius changes so that (u, 1) stands at right angles to the
// sheet in four dimensions. Bounds by boxes of centres and largest radii are worse by the size of the box.
class SupportTree {
 public:
  using Item = std::array<Sphere, 3>;  // the balls interpolated; edges and single balls repeat theirs

  SupportTree() = default;
  explicit SupportTree(std::vector<Item> items);

  // The least of `best` and value(item, balls of the item, least so far) over all items. Precondition: value() is at
  // least the least |query - c| - r of the item. Items that cannot be the least are not asked. A value below `enough`
  // ends the search.
  template <class Value>
  double min(const Point& query, double best, const Value& value,
             double enough = -std::numeric_limits<double>::infinity()) const {
    if (items_.empty()) return best;
    std::array<std::pair<double, Index>, kDepth> stack;
    std::size_t size = 0;
    stack[size++] = {bound(nodes_[0], query), 0};
    while (size > 0 && best >= enough) {
      const auto [lower, at] = stack[--size];
      if (!(lower < best)) continue;
      const Node& node = nodes_[at];
      if (node.count > 0) {
        for (Index i = node.first; i < node.first + node.count; ++i)
          best = std::min(best, value(numbers_[i], items_[i], best));
        continue;
      }
      std::array<std::pair<double, Index>, 2> children{std::pair{bound(nodes_[node.first], query), node.first},
                                                       std::pair{bound(nodes_[node.first + 1], query), node.first + 1}};
      if (children[0].first < children[1].first) std::swap(children[0], children[1]);
      for (const auto& child : children) stack[size++] = child;  // the nearer one is popped first
    }
    return best;
  }

 private:
  static constexpr std::size_t kDepth = 128;  // twice the depth of a tree split in the middle, and more
  struct Node {
    Eigen::Vector4d middle = Eigen::Vector4d::Zero();
    Eigen::Matrix4d half_axes = Eigen::Matrix4d::Zero();  // columns
    double slack = 0;                                     // for rounding
    Index first = 0, count = 0;  // of a leaf: items; of an inner node (count 0): its two children
  };

  static double bound(const Node& node, const Point& query);
  void build(Index at, Index first, Index count);

  std::vector<Item> items_;     // in the order of the leaves
  std::vector<Index> numbers_;  // of each, as given
  std::vector<Node> nodes_;
};

}  // namespace orchard::detail
