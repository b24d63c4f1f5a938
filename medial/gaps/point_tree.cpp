#include "point_tree.h"

namespace orchard::detail {
namespace {

constexpr Index kLeafSize = 8;
// At this depth, half boxes are narrower than any distance that is kept between two points.
constexpr int kMaxDepth = 150;

}  // namespace

void PointTree::add(const Point& point) {
  const Index added = static_cast<Index>(points_.size());
  points_.push_back(point);
  next_.push_back(kNone);
  Box region = bounds_;
  Index at = 0;
  for (int depth = 0;; ++depth) {
    int axis = 0;
    region.sizes().maxCoeff(&axis);
    const double middle = region.center()[axis];
    nodes_[at].box.extend(point);
    if (nodes_[at].children == kNone) {
      next_[added] = nodes_[at].first;
      nodes_[at].first = added;
      if (++nodes_[at].count > kLeafSize && depth < kMaxDepth) split(at, axis, middle);
      return;
    }
    const bool upper = point[axis] > middle;
    (upper ? region.min() : region.max())[axis] = middle;
    at = nodes_[at].children + (upper ? 1 : 0);
  }
}

void PointTree::split(Index node, int axis, double middle) {
  const Index children = static_cast<Index>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  Index following = kNone;
  for (Index i = nodes_[node].first; i != kNone; i = following) {
    following = next_[i];
    Node& child = nodes_[children + (points_[i][axis] > middle ? 1 : 0)];
    child.box.extend(points_[i]);
    next_[i] = child.first;
    child.first = i;
    ++child.count;
  }
  nodes_[node].first = kNone;
  nodes_[node].children = children;
}

}  // namespace orchard::detail
