#include "slab_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace orchard::detail {
namespace {

constexpr Index kSlabLeaf = 4;  // triangles at most
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

SlabTree::SlabTree(const Surface& surface) : surface_(surface) {
  const auto& mesh = surface.mesh();
  for (const auto& [a, b, c] : mesh.triangles)
    middles_.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  triangles_.resize(mesh.triangles.size());
  std::iota(triangles_.begin(), triangles_.end(), Index{0});
  nodes_.reserve(triangles_.size());
  nodes_.emplace_back();
  fill(0, 0, static_cast<Index>(triangles_.size()));
  middles_ = {};
}

// Divides the triangles into halves along the longest side of their middles' box.
void SlabTree::fill(Index node, Index begin, Index end) {
  bound(nodes_[node], begin, end);
  if (end - begin <= kSlabLeaf) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  Box box;
  for (Index i = begin; i < end; ++i) box.extend(middles_[triangles_[i]]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const Index middle = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](Index a, Index b) { return std::pair(middles_[a][axis], a) < std::pair(middles_[b][axis], b); });
  const auto children = static_cast<Index>(nodes_.size());
  nodes_[node].children = children;
  nodes_.resize(nodes_.size() + 2);
  fill(children, begin, middle);
  fill(children + 1, middle, end);
}

void SlabTree::bound(Node& node, Index begin, Index end) const {
  const auto each_corner = [&](const auto& visit) {
    for (Index i = begin; i < end; ++i) {
      for (const Point& corner : surface_.corners(triangles_[i])) visit(corner);
    }
  };
  Box box;
  each_corner([&](const Point& corner) { box.extend(corner); });
  node.center = box.center();
  double squared = 0;
  each_corner([&](const Point& corner) { squared = std::max(squared, (corner - node.center).squaredNorm()); });
  node.radius = std::sqrt(squared);
  Vector sum = Vector::Zero();
  for (Index i = begin; i < end; ++i) sum += surface_.area(triangles_[i]) * surface_.normal(triangles_[i]);
  node.low = -kInfinity, node.high = kInfinity;
  if (!(sum.norm() > 0)) return;
  node.normal = sum.normalized();
  double low = kInfinity, high = -kInfinity;
  each_corner([&](const Point& corner) {
    low = std::min(low, node.normal.dot(corner));
    high = std::max(high, node.normal.dot(corner));
  });
  node.low = low, node.high = high;
}

// An upper bound on the depth n (p - q) of the node's places q below the tangent plane. It is the lesser of two bounds:
// one by the node's ball alone; and one by its slab along the slab's normal and by its ball across it. It is the slab
// that excludes the neighbourhood of p.
double SlabTree::max_depth(const Node& node, const TangentPlace& place, const Vector& way) {
  const double by_ball = place.normal.dot(way) + node.radius;
  const double cosine = node.normal.dot(place.normal), at = node.normal.dot(place.position);
  if (cosine == 0 || !std::isfinite(node.low)) return by_ball;
  const Vector across = place.normal - cosine * node.normal;
  const double by_slab =
      cosine * (at - (cosine > 0 ? node.low : node.high)) + across.dot(way) + across.norm() * node.radius;
  return std::min(by_ball, by_slab);
}

double SlabTree::min_touch(const Node& node, const TangentPlace& place) {
  const Vector way = place.position - node.center;
  const double depth = max_depth(node, place, way), squared = way.squaredNorm(), radius = node.radius;
  const double nearest = std::max(std::sqrt(squared) - radius, 0.0);
  if (depth <= 0 || depth < place.sine * nearest) return kInfinity;
  double bound = nearest * nearest / (2 * depth);
  if (nearest > 0) bound = std::max(bound, (squared - radius * radius) / (2 * (place.normal.dot(way) + radius)));
  const double at = node.normal.dot(place.position), cosine = node.normal.dot(place.normal);
  if (at > node.high && 1 + cosine > 0) bound = std::max(bound, (at - node.high) / (1 + cosine));
  if (at < node.low && 1 - cosine > 0) bound = std::max(bound, (node.low - at) / (1 - cosine));
  return bound;
}

double SlabTree::min_ray(const Node& node, const TangentPlace& place) {
  const Vector way = place.position - node.center;
  const double depth = place.normal.dot(way), squared = way.squaredNorm(), radius2 = node.radius * node.radius;
  if (squared <= radius2) return 0;
  const double inside = depth * depth - squared + radius2;
  if (depth < 0 || inside < -1e-12 * squared) return kInfinity;
  return (depth - std::sqrt(std::max(inside, 0.0))) / 2;
}

}  // namespace orchard::detail
