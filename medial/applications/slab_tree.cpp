#include "slab_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace orchard::detail {
namespace {

constexpr auto kFanOut = static_cast<Index>(SlabTree::kWidth);

// The centre of the smallest ball around a triangle.
Point middle_of(const std::array<Point, 3>& corners) {
  std::size_t i = 0;  // the longest edge is opposite this corner
  double longest = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double squared = (corners[(k + 1) % 3] - corners[(k + 2) % 3]).squaredNorm();
    if (squared > longest) i = k, longest = squared;
  }
  const Vector a = corners[(i + 1) % 3] - corners[i], b = corners[(i + 2) % 3] - corners[i], normal = a.cross(b);
  if (!(a.dot(b) > 0) || !(normal.squaredNorm() > 0)) return (corners[(i + 1) % 3] + corners[(i + 2) % 3]) / 2;
  return corners[i] + (a.squaredNorm() * b - b.squaredNorm() * a).cross(normal) / (2 * normal.squaredNorm());
}

}  // namespace

SlabTree::SlabTree(const Surface& surface) : surface_(surface) {
  const auto& mesh = surface.mesh();
  middles_.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
    middles_.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  triangles_.resize(mesh.triangles.size());
  std::iota(triangles_.begin(), triangles_.end(), Index{0});
  nodes_.reserve(triangles_.size() / 3 + 16);
  fill(0, static_cast<Index>(triangles_.size()));
  middles_ = {};
  triangles_ = {};
}

// Divides the triangles among the children so that all subtrees but the last are full. Returns the number of the node.
Index SlabTree::fill(Index begin, Index end) {
  const auto index = static_cast<Index>(nodes_.size());
  nodes_.emplace_back();
  Index full = 1;  // triangles of a child
  while (full < (end - begin + kFanOut - 1) / kFanOut) full *= kFanOut;
  if (end - begin > 2 * full) halve(begin, begin + 2 * full, end);
  halve(begin, begin + full, std::min(begin + 2 * full, end));
  if (end - begin > 3 * full) halve(begin + 2 * full, begin + 3 * full, end);
  Node node;
  node.is_leaf = full == 1;
  for (Index first = begin; first < end; first += full) {
    const Index last = std::min(first + full, end);
    bound(node, node.count, first, last);
    node.children[node.count++] = node.is_leaf ? triangles_[first] : fill(first, last);
  }
  nodes_[index] = node;
  return index;
}

// Puts the triangles that are lower along the longest side of their middles' box first.
void SlabTree::halve(Index begin, Index middle, Index end) {
  if (middle >= end) return;
  Box box;
  for (Index i = begin; i < end; ++i) box.extend(middles_[triangles_[i]]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](Index a, Index b) { return std::pair(middles_[a][axis], a) < std::pair(middles_[b][axis], b); });
}

void SlabTree::bound(Node& node, Index child, Index begin, Index end) const {
  const auto each_corner = [&](const auto& visit) {
    for (Index i = begin; i < end; ++i) {
      for (const Point& corner : surface_.corners(triangles_[i])) visit(corner);
    }
  };
  Box box;
  each_corner([&](const Point& corner) { box.extend(corner); });
  const Point center = end - begin == 1 ? middle_of(surface_.corners(triangles_[begin])) : box.center();
  Vector normal = Vector::Zero();
  for (Index i = begin; i < end; ++i) normal += surface_.area(triangles_[i]) * surface_.normal(triangles_[i]);
  normal.normalize();  // stays zero if it is
  double squared = 0, low = 0, high = 0, spread = 1;
  each_corner([&](const Point& corner) {
    const double height = normal.dot(corner - center);
    low = std::min(low, height);
    high = std::max(high, height);
    squared = std::max(squared, (corner - center).squaredNorm());
  });
  for (Index i = begin; i < end; ++i) {
    const Vector& other = surface_.normal(triangles_[i]);
    spread = other.isZero(0) ? -1 : std::min(spread, normal.dot(other));
  }
  node.center.row(child) = center.transpose();
  node.normal.row(child) = normal.transpose();
  node.radius[child] = std::sqrt(squared);
  node.low[child] = low, node.high[child] = high, node.spread[child] = spread;
}

}  // namespace orchard::detail
