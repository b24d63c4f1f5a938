#include "nearest_point.h"

#include <algorithm>
#include <utility>

namespace orchard::detail {
namespace {

constexpr Index kLeafSize = 8;

}  // namespace

NearestPoint::NearestPoint(std::span<const Point> points) : points_(points.begin(), points.end()) {
  nodes_.reserve(points.size() / 2 + 1);
  build(0, static_cast<Index>(points.size()));
}

void NearestPoint::build(Index begin, Index end) {
  const std::size_t node = nodes_.size();
  nodes_.push_back({.begin = begin, .end = end});
  if (end - begin <= kLeafSize) return;
  Box box;
  for (Index i = begin; i < end; ++i) box.extend(points_[i]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const Index middle = begin + (end - begin) / 2;
  std::nth_element(points_.begin() + begin, points_.begin() + middle, points_.begin() + end,
                   [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
  nodes_[node].axis = axis;
  nodes_[node].split = points_[middle][axis];
  build(begin, middle);
  nodes_[node].right = static_cast<Index>(nodes_.size());
  build(middle, end);
}

double NearestPoint::squared_distance(const Point& q, double limit) const {
  Vector offset = Vector::Zero();
  search(0, q, offset, limit);
  return limit;
}

// The offset holds, for each axis, how far q is outside the node's slab (Arya and Mount's incremental distance).
void NearestPoint::search(Index index, const Point& q, Vector& offset, double& best) const {
  const Node& node = nodes_[index];
  if (node.right == kNone) {
    for (Index i = node.begin; i < node.end; ++i) best = std::min(best, (points_[i] - q).squaredNorm());
    return;
  }
  const double beyond = q[node.axis] - node.split;
  search(beyond < 0 ? index + 1 : node.right, q, offset, best);
  const double before = std::exchange(offset[node.axis], beyond);
  if (offset.squaredNorm() < best) search(beyond < 0 ? node.right : index + 1, q, offset, best);
  offset[node.axis] = before;
}

}  // namespace orchard::detail
