#include <algorithm>
#include <cmath>
#include <limits>

#include "triangle_tree.h"
#include "triangle_tree_builder.h"

namespace orchard::detail {
namespace {

constexpr float kSlack = 1e-5f;       // more than all float roundings of a slab test beside a mesh of size one
constexpr double kSlabReach = 1e6;    // farther corners would cost the slab its digits
constexpr double kFloatReach = 1e30;  // farther corners are no floats

Float4 broadcast(float x) { return Float4{x, x, x, x}; }

bool boxes_meet(const Box& box, const std::array<Point, 3>& p) {
  return !box.intersection(Box(p[0].cwiseMin(p[1]).cwiseMin(p[2]), p[0].cwiseMax(p[1]).cwiseMax(p[2]))).isEmpty();
}

}  // namespace

// A triangle in the tree's coordinates: its box, and what it spans along its normal. Any direction makes a valid slab,
// so a needle's poor normal only makes a poor filter.
class TriangleTree::TriangleQuery {
 public:
  TriangleQuery(const std::array<Point, 3>& corners, const Point& center, double scale) {
    std::array<Point, 3> p;
    double reach = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = scale * (corners[i] - center);
      reach = std::max(reach, p[i].cwiseAbs().maxCoeff());
    }
    usable_ = reach < kFloatReach;
    for (int axis = 0; axis < 3; ++axis) {
      const auto [lower, upper] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
      lower_[axis] = broadcast(static_cast<float>(lower) - kSlack - kSlack * static_cast<float>(std::fabs(lower)));
      upper_[axis] = broadcast(static_cast<float>(upper) + kSlack + kSlack * static_cast<float>(std::fabs(upper)));
    }
    if (reach < kSlabReach) find_slab(p);
  }
  bool usable() const { return usable_; }

  // For each child, all bits set if it may hold something that meets the triangle.
  auto meets(const Node& node) const {
    auto result = node.lower[0] <= upper_[0];
    Float4 middle = broadcast(0), reach = broadcast(kSlack);
    for (int axis = 0; axis < 3; ++axis) {
      result &= (node.lower[axis] <= upper_[axis]) & (node.upper[axis] >= lower_[axis]);
      middle += normal_[axis] * (0.5f * (node.lower[axis] + node.upper[axis]));
      reach += (normal_[axis] < 0 ? -normal_[axis] : normal_[axis]) * (0.5f * (node.upper[axis] - node.lower[axis]));
    }
    return result & (middle - reach <= slab_upper_) & (middle + reach >= slab_lower_);
  }

 private:
  void find_slab(const std::array<Point, 3>& p) {
    const Vector normal = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
    if (!(normal.norm() > 0.5)) return;
    const auto [lower, upper] = std::minmax({normal.dot(p[0]), normal.dot(p[1]), normal.dot(p[2])});
    for (int axis = 0; axis < 3; ++axis) normal_[axis] = broadcast(static_cast<float>(normal[axis]));
    slab_lower_ = broadcast(static_cast<float>(lower) - kSlack);
    slab_upper_ = broadcast(static_cast<float>(upper) + kSlack);
  }

  bool usable_ = false;
  Float4 lower_[3], upper_[3];
  Float4 normal_[3] = {};
  Float4 slab_lower_ = broadcast(-std::numeric_limits<float>::max());
  Float4 slab_upper_ = broadcast(std::numeric_limits<float>::max());
};

void TriangleTree::overlapping(const std::array<Point, 3>& triangle, std::vector<Index>& out) const {
  out.clear();
  Box box;
  for (const Point& p : triangle) box.extend(p);
  const auto add_if_met = [&](Index t) {
    const auto other = corners(t);
    if (boxes_meet(box, other) && triangles_meet(triangle, other)) out.push_back(t);
  };
  const TriangleQuery query(triangle, center_, scale_);
  if (!query.usable()) {
    for (Index t = 0; t < mesh_.triangles.size(); ++t) add_if_met(t);
    return;
  }
  std::vector<Index> stack{0};
  while (!stack.empty()) {
    const Index child = stack.back();
    stack.pop_back();
    if (child >= Builder::kLeaf) {
      for (const Index t : leaves_[child - Builder::kLeaf].triangle)
        if (t != kNone) add_if_met(t);
      continue;
    }
    const auto meets = query.meets(nodes_[child]);
    for (int k = 0; k < 4; ++k)
      if (meets[k]) stack.push_back(nodes_[child].child[k]);
  }
  std::sort(out.begin(), out.end());
}

}  // namespace orchard::detail
