#include "diagram/nearest_point.h"

#include <Eigen/Eigenvalues>
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
  const std::size_t index = nodes_.size();
  Node node;
  node.begin = begin;
  node.end = end;
  Point mean = Point::Zero();
  for (Index i = begin; i < end; ++i) mean += points_[i];
  mean /= std::max<Index>(end - begin, 1);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (Index i = begin; i < end; ++i) covariance += (points_[i] - mean) * (points_[i] - mean).transpose();
  node.axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().transpose();
  for (Index i = begin; i < end; ++i) node.box.extend(node.axes * points_[i]);
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) return;
  const Vector axis = node.axes.row(2);  // the axis of greatest extent
  const Index middle = begin + (end - begin) / 2;
  std::nth_element(points_.begin() + begin, points_.begin() + middle, points_.begin() + end,
                   [&](const Point& a, const Point& b) { return axis.dot(a) < axis.dot(b); });
  build(begin, middle);
  nodes_[index].right = static_cast<Index>(nodes_.size());
  build(middle, end);
}

// A little less than the computed value, because of the rounding errors of the rotation.
double NearestPoint::squared_distance_bound(Index node, const Point& q) const {
  return nodes_[node].box.squaredExteriorDistance(nodes_[node].axes * q) * (1 - 0x1p-40);
}

double NearestPoint::squared_distance(const Point& q, double limit) const {
  if (!points_.empty()) search(0, q, limit);
  return limit;
}

void NearestPoint::search(Index index, const Point& q, double& best) const {
  const Node& node = nodes_[index];
  if (node.right == kNone) {
    for (Index i = node.begin; i < node.end; ++i) best = std::min(best, (points_[i] - q).squaredNorm());
    return;
  }
  Index near = index + 1, far = node.right;
  double near_distance = squared_distance_bound(near, q);
  double far_distance = squared_distance_bound(far, q);
  if (far_distance < near_distance) std::swap(near, far), std::swap(near_distance, far_distance);
  if (near_distance < best) search(near, q, best);
  if (far_distance < best) search(far, q, best);
}

bool NearestPoint::within(const Point& q, double squared_radius, std::size_t max, std::vector<Point>& found) const {
  found.clear();
  if (!points_.empty()) collect(0, q, squared_radius, max, found);
  return found.size() <= max;
}

void NearestPoint::collect(Index index, const Point& q, double squared_radius, std::size_t max,
                           std::vector<Point>& found) const {
  const Node& node = nodes_[index];
  if (node.right == kNone) {
    for (Index i = node.begin; i < node.end; ++i)
      if ((points_[i] - q).squaredNorm() <= squared_radius) found.push_back(points_[i]);
    return;
  }
  for (const Index child : {index + 1, node.right})
    if (found.size() <= max && squared_distance_bound(child, q) <= squared_radius)
      collect(child, q, squared_radius, max, found);
}

}  // namespace orchard::detail
