#include "disk_tree.h"

#include <algorithm>

namespace orchard::detail {
namespace {

constexpr Index kLeafSize = 4;

}  // namespace

Eigen::AlignedBox2d box_of(const Disk& disk) {
  const Point2 half = Point2::Constant(disk.radius);
  return {disk.center - half, disk.center + half};
}

DiskTree::DiskTree(std::span<const Disk> disks) {
  boxes_.resize(disks.size());
  for (Index i = 0; i < disks.size(); ++i) {
    if (disks[i].radius <= 0) continue;
    boxes_[i] = box_of(disks[i]);
    order_.push_back(i);
  }
  if (!order_.empty()) build(0, static_cast<Index>(order_.size()));
}

// Splits at the median of the longer axis; ties go by index, so that the tree is always the same.
void DiskTree::build(Index begin, Index end) {
  const auto index = static_cast<Index>(nodes_.size());
  nodes_.push_back({{}, begin, end, index + 1, end - begin <= kLeafSize});
  Eigen::AlignedBox2d box, centers;
  for (Index i = begin; i < end; ++i) {
    box.extend(boxes_[order_[i]]);
    centers.extend(boxes_[order_[i]].center());
  }
  nodes_[index].box = box;
  if (nodes_[index].leaf) return;
  const int axis = centers.sizes().x() >= centers.sizes().y() ? 0 : 1;
  const Index middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](Index a, Index b) {
    const double at_a = boxes_[a].center()[axis], at_b = boxes_[b].center()[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  build(begin, middle);
  build(middle, end);
  nodes_[index].after = static_cast<Index>(nodes_.size());
}

void DiskTree::meeting(const Eigen::AlignedBox2d& box, std::vector<Index>& out) const {
  out.clear();
  for (Index i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const bool meets = node.box.intersects(box);
    if (meets && node.leaf)
      for (Index k = node.begin; k < node.end; ++k)
        if (boxes_[order_[k]].intersects(box)) out.push_back(order_[k]);
    i = meets ? i + 1 : node.after;
  }
  std::sort(out.begin(), out.end());
}

}  // namespace orchard::detail
