#pragma once
#include <cstddef>
#include <limits>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// A tree around points that come one by one, each to be asked about before the next one comes. It halves space, not
// points, so that no order of arrival makes it deep; the boxes are tight around the points that are there.
class PointTree {
 public:
  // `bounds`: about where the points will be. Others are found, too, but may be looked for longer.
  explicit PointTree(const Box& bounds) : bounds_(bounds), nodes_(1) {}

  // O(log n) for points that keep apart.
  void add(const Point& point);

  // Whether any point passes the test among those that lie within the distance of the query. Some that lie farther away
  // are tested, too, so the test has to measure; what it answers to does not depend on the tree. O(log n) if few points
  // lie near the edge of that ball.
  template <typename Test>
  bool any_within(const Point& query, double distance, const Test& test) const {
    // Rounding may let a box seem farther away than its points are.
    const double limit = distance * distance * (1 + 0x1p-40) + std::numeric_limits<double>::min();
    open_.assign(1, 0);
    while (!open_.empty()) {
      const Node& node = nodes_[open_.back()];
      open_.pop_back();
      ++steps_;
      if (node.box.squaredExteriorDistance(query) > limit) continue;
      if (node.children != kNone) {
        open_.push_back(node.children + 1);
        open_.push_back(node.children);
        continue;
      }
      for (Index i = node.first; i != kNone; i = next_[i]) {
        ++steps_;
        if (test(points_[i])) return true;
      }
    }
    return false;
  }

  // How many boxes and points all questions together have looked at: the cost, in numbers that no machine changes.
  std::size_t steps() const { return steps_; }

 private:
  struct Node {
    Box box;                 // of its points
    Index children = kNone;  // the first of two, one after the other; kNone in a leaf
    Index first = kNone;     // a leaf's points, each followed by next_
    Index count = 0;         // of a leaf's points
  };

  void split(Index node, int axis, double middle);

  Box bounds_;
  std::vector<Point> points_;
  std::vector<Index> next_;
  std::vector<Node> nodes_;
  mutable std::vector<Index> open_;
  mutable std::size_t steps_ = 0;
};

}  // namespace orchard::detail
