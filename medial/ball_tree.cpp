#include "ball_tree.h"

#include <numeric>

namespace orchard::detail {
namespace {

constexpr Index kBallLeaf = 4;

}  // namespace

BallTree::BallTree(std::vector<Box> boxes, std::vector<double> radii)
    : boxes_(std::move(boxes)), radii_(std::move(radii)), items_(boxes_.size()) {
  if (items_.empty()) return;
  std::iota(items_.begin(), items_.end(), Index{0});
  nodes_.emplace_back();
  build(0, 0, static_cast<Index>(items_.size()));
  // Puts the items in the order of the leaves.
  std::vector<Box> sorted_boxes;
  std::vector<double> sorted_radii;
  for (const Index item : items_) {
    sorted_boxes.push_back(boxes_[item]);
    sorted_radii.push_back(radii_[item]);
  }
  boxes_ = std::move(sorted_boxes);
  radii_ = std::move(sorted_radii);
}

void BallTree::build(Index at, Index first, Index count) {
  Node node;
  Box middles;
  for (Index i = first; i < first + count; ++i) {
    node.box.extend(boxes_[items_[i]]);
    middles.extend(boxes_[items_[i]].center());
    node.radius = std::max(node.radius, radii_[items_[i]]);
  }
  if (count <= kBallLeaf) {
    node.first = first;
    node.count = count;
    nodes_[at] = node;
    return;
  }
  int axis = 0;
  middles.sizes().maxCoeff(&axis);
  const auto begin = items_.begin() + first;
  const Index half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](Index a, Index b) {
    const double x = boxes_[a].min()[axis] + boxes_[a].max()[axis], y = boxes_[b].min()[axis] + boxes_[b].max()[axis];
    return x != y ? x < y : a < b;
  });
  node.first = static_cast<Index>(nodes_.size());
  nodes_[at] = node;
  nodes_.resize(nodes_.size() + 2);
  build(node.first, first, half);
  build(node.first + 1, first + half, count - half);
}

}  // namespace orchard::detail
