#pragma once
#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// A bounding volume hierarchy over families of balls: the centres of item i lie in boxes[i], and no radius is above
// radii[i]. So a point's distance from the balls of an item is at least its distance from the box minus the radius.
class BallTree {
 public:
  BallTree(std::vector<Box> boxes, std::vector<double> radii);

  // Returns the least of `best` and value(item) over all items. Precondition: value(item) is at least distance(query,
  // box) minus scale * radius. value() is not called for items that cannot be the least. The search ends when a value
  // is at most `enough`. Runs in the calling thread; several threads may call it at once.
  template <class Value>
  double min(const Point& query, double best, const Value& value, double scale = 1,
             double enough = -std::numeric_limits<double>::infinity()) const {
    if (items_.empty()) return best;
    std::array<std::pair<double, Index>, kDepth> stack;
    std::size_t size = 0;
    stack[size++] = {bound(nodes_[0], query, scale), 0};
    while (size > 0 && best > enough) {
      const auto [lower, at] = stack[--size];
      if (!(lower < best)) continue;
      const Node& node = nodes_[at];
      if (node.count > 0) {
        for (Index i = node.first; i < node.first + node.count; ++i) {
          if (distance(boxes_[i], query) - scale * radii_[i] < best) best = std::min(best, value(items_[i]));
        }
        continue;
      }
      std::array<std::pair<double, Index>, 2> children{
          std::pair{bound(nodes_[node.first], query, scale), node.first},
          std::pair{bound(nodes_[node.first + 1], query, scale), node.first + 1}};
      if (children[0].first < children[1].first) std::swap(children[0], children[1]);
      for (const auto& child : children) stack[size++] = child;  // the nearer one is popped first
    }
    return best;
  }

  // Returns the largest radii[item] of the items that accept(item) accepts and whose distance from the query, to the
  // box minus the radius, is at most `limit`; `least` if none is larger. accept() is not called for items that cannot
  // be the largest.
  template <class Accept>
  double max_radius(const Point& query, double limit, double min, const Accept& accept) const {
    if (items_.empty()) return min;
    std::array<Index, kDepth> stack;
    std::size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (!(node.radius > min) || bound(node, query, 1) > limit) continue;
      if (node.count == 0) {
        const bool first_larger = nodes_[node.first].radius > nodes_[node.first + 1].radius;
        stack[size++] = node.first + (first_larger ? 1 : 0);  // the larger one is popped first
        stack[size++] = node.first + (first_larger ? 0 : 1);
        continue;
      }
      for (Index i = node.first; i < node.first + node.count; ++i) {
        const bool may = radii_[i] > min && distance(boxes_[i], query) - radii_[i] <= limit;
        if (may && accept(items_[i])) min = radii_[i];
      }
    }
    return min;
  }

 private:
  static constexpr std::size_t kDepth = 128;  // more than twice the depth of a tree that is split in the middle
  struct Node {
    Box box;
    double radius = 0;
    Index first = 0, count = 0;  // a leaf's items; for an inner node (count 0), its two children
  };

  static double distance(const Box& box, const Point& query) { return box.exteriorDistance(query); }
  static double bound(const Node& node, const Point& query, double scale) {
    return distance(node.box, query) - scale * node.radius;
  }
  void build(Index node, Index first, Index count);

  std::vector<Box> boxes_;
  std::vector<double> radii_;
  std::vector<Index> items_;
  std::vector<Node> nodes_;
};

}  // namespace orchard::detail
