#include "support_tree.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>

namespace orchard::detail {
namespace {

constexpr Index kLeaf = 4;
constexpr double kRounding = 1e-13;  // of the coordinates: more than a bound is off by

Eigen::Vector4d in_four(const Sphere& ball) { return {ball.center.x(), ball.center.y(), ball.center.z(), ball.radius}; }

}  // namespace

SupportTree::SupportTree(std::vector<Item> items) : items_(std::move(items)), numbers_(items_.size()) {
  if (items_.empty()) return;
  std::iota(numbers_.begin(), numbers_.end(), Index{0});
  nodes_.emplace_back();
  build(0, 0, static_cast<Index>(items_.size()));
  std::vector<Item> sorted;
  sorted.reserve(items_.size());
  for (const Index number : numbers_) sorted.push_back(items_[number]);
  items_ = std::move(sorted);
}

double SupportTree::bound(const Node& node, const Point& query) {
  const Vector way = query - node.middle.head<3>();
  const double length = way.norm();
  if (!(length > 0)) return -std::numeric_limits<double>::infinity();
  Eigen::Vector4d support;
  support << way / length, 1.0;
  const double added = (support.transpose() * node.half_axes).cwiseAbs().sum();
  return length - node.middle[3] - added - node.slack;
}

void SupportTree::build(Index at, Index first, Index count) {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  Eigen::Matrix4d spread = Eigen::Matrix4d::Zero();
  const auto visit = [&](const auto& look_at) {
    for (Index i = first; i < first + count; ++i) {
      for (const Sphere& ball : items_[numbers_[i]]) look_at(in_four(ball));
    }
  };
  visit([&](const Eigen::Vector4d& ball) { mean += ball / (3.0 * count); });
  visit([&](const Eigen::Vector4d& ball) { spread += (ball - mean) * (ball - mean).transpose(); });
  const Eigen::Matrix4d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(spread).eigenvectors();
  Eigen::Vector4d low = Eigen::Vector4d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  visit([&](const Eigen::Vector4d& ball) {
    const Eigen::Vector4d place = axes.transpose() * (ball - mean);
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  });
  Node node;
  node.middle = mean + axes * (0.5 * (low + high));
  node.half_axes = axes * (0.5 * (high - low)).asDiagonal();
  node.slack = kRounding * (node.middle.norm() + (high - low).norm());
  if (count <= kLeaf) {
    node.first = first;
    node.count = count;
    nodes_[at] = node;
    return;
  }
  const Eigen::Vector4d longest = axes.col(3);  // of the largest eigenvalue
  const auto begin = numbers_.begin() + first;
  const Index half = count / 2;
  const auto along = [&](Index item) {
    const Item& balls = items_[item];
    return longest.dot(in_four(balls[0]) + in_four(balls[1]) + in_four(balls[2]));
  };
  std::nth_element(begin, begin + half, begin + count, [&](Index a, Index b) {
    const double x = along(a), y = along(b);
    return x != y ? x < y : a < b;
  });
  node.first = static_cast<Index>(nodes_.size());
  nodes_[at] = node;
  nodes_.resize(nodes_.size() + 2);
  const Index children = node.first;
  build(children, first, half);
  build(children + 1, first + half, count - half);
}

}  // namespace orchard::detail
