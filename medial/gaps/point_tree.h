#pragma once
#include <cstddef>
#include <limits>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// A tree of points that are added one by one, with queries in between. It halves space and not the points, so no order
// of insertion makes it deep. The boxes are tight around the present points.
class PointTree {
 public:
  // `bounds` is the approximate box of the points. Points outside are found, too, but searching them may take longer.
  explicit PointTree(const Box& bounds) : bounds_(bounds), nodes_(1) {}

  // Adds a point. O(log n) for points that are not too close together.
  void add(const Point& point);

  // Returns whether a point within the distance of the query passes the test. Some points that lie farther away are
  // tested, too, so the test has to measure the distance itself. O(log n) if few points lie near the boundary of that
  // ball.
  template <typename Test>
  bool any_within(const Point& query, double distance, const Test& test) const {
    // Because of rounding, a box may seem to be farther away than its points.
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

  // Returns the number of boxes and points that all queries together have visited, which measures the cost
  // independently of the machine.
  std::size_t steps() const { return steps_; }

 private:
  struct Node {
    Box box;                 // of its points
    Index children = kNone;  // the first of two consecutive children; kNone in a leaf
    Index first = kNone;     // the first point of a leaf; next_ has the others
    Index count = 0;         // the number of points of a leaf
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
