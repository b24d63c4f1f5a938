#include "detector/sphere_tree.h"

#include <algorithm>
#include <bit>
#include <tuple>

namespace orchard::runtime::detail {

void SphereTree::add(const BoundingSphere& sphere, BodyIndex body, std::uint32_t part) {
  constexpr double kRoom = 1e-9;  // relative to coordinates and radii
  const double reach = sphere.reach + kRoom * sphere.size;
  const bool known = std::isfinite(reach);  // otherwise, it may be anywhere
  parts_.push_back({known ? sphere.center : Vec3{}, known ? reach : kInfinity, body, part});
}

void SphereTree::build(std::uint32_t leaf) {
  nodes_.clear();
  leaf_ = leaf;
  if (!parts_.empty()) build(0, static_cast<std::uint32_t>(parts_.size()));
}

// Divides a node across the longest axis of its box. The first child gets a power of two of the parts, so all leaves
// but one are full.
std::uint32_t SphereTree::build(std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node node{parts_[begin].center, parts_[begin].center, begin, end};
  for (std::uint32_t i = begin; i < end; ++i) {
    const Part& part = parts_[i];
    for (std::size_t d = 0; d < 3; ++d) {
      node.low[d] = std::min(node.low[d], part.center[d] - part.reach);
      node.high[d] = std::max(node.high[d], part.center[d] + part.reach);
    }
  }
  nodes_.push_back(node);
  if (end - begin <= leaf_) return index;
  const Vec3 extent = node.high - node.low;
  const std::size_t axis = static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
  const std::uint32_t middle = begin + std::bit_ceil(end - begin) / 2;
  const auto at = [&](std::uint32_t i) { return parts_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [axis](const Part& p, const Part& q) {
    return std::tie(p.center[axis], p.body, p.part) < std::tie(q.center[axis], q.body, q.part);
  });
  build(begin, middle);
  const std::uint32_t second = build(middle, end);
  nodes_[index].second = second;
  return index;
}

}  // namespace orchard::runtime::detail
