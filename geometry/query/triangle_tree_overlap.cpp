#include <algorithm>
#include <cmath>

#include "triangle_tree.h"
#include "triangle_tree_builder.h"

namespace orchard::detail {
namespace {

// Larger than all float rounding errors of a slab test, in a mesh scaled to size one.
constexpr float kSlabSlack = 1e-5f;
constexpr double kSlabReach = 1e6;    // corners farther away would make the slab too imprecise
constexpr double kFloatReach = 1e30;  // corners farther away do not fit into floats

bool boxes_meet(const Box& box, const std::array<Point, 3>& p) {
  return !box.intersection(Box(p[0].cwiseMin(p[1]).cwiseMin(p[2]), p[0].cwiseMax(p[1]).cwiseMax(p[2]))).isEmpty();
}

}  // namespace

// A triangle in the tree's coordinates: its ranges along the axes, along its normal, and along the normals of its edges
// in its plane. Any direction makes a valid slab, so imprecise normals of a needle make the filter weaker but not
// wrong.
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
      lower_[axis] =
          broadcast(static_cast<float>(lower) - kSlabSlack - kSlabSlack * static_cast<float>(std::fabs(lower)));
      upper_[axis] =
          broadcast(static_cast<float>(upper) + kSlabSlack + kSlabSlack * static_cast<float>(std::fabs(upper)));
    }
    if (reach > kSlabReach) return;
    const Vector normal = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
    add_slab(normal, p);
    for (std::size_t i = 0; i < 3; ++i) add_slab(normal.cross(p[(i + 1) % 3] - p[i]).stableNormalized(), p);
  }
  bool usable() const { return usable_; }

  // Sets all bits of each child that may contain something that meets the triangle.
  auto meets(const Node& node) const {
    auto result = node.lower[0] <= upper_[0];
    Float4 middle[3], half[3];
    for (int axis = 0; axis < 3; ++axis) {
      result &= (node.lower[axis] <= upper_[axis]) & (node.upper[axis] >= lower_[axis]);
      middle[axis] = 0.5f * (node.lower[axis] + node.upper[axis]);
      half[axis] = 0.5f * (node.upper[axis] - node.lower[axis]);
    }
    for (std::size_t i = 0; i < slab_count_; ++i) {
      const Slab& slab = slabs_[i];
      const Float4 at = dot(slab.direction, middle), reach = dot(slab.size, half);
      result &= (at - reach <= slab.upper) & (at + reach >= slab.lower);
    }
    return result;
  }

 private:
  struct Slab {
    Float4 direction[3], size[3];  // unit vectors, and their absolute values
    Float4 lower, upper;
  };

  void add_slab(const Vector& direction, const std::array<Point, 3>& p) {
    if (!(direction.norm() > 0.5)) return;
    const auto [lower, upper] = std::minmax({direction.dot(p[0]), direction.dot(p[1]), direction.dot(p[2])});
    Slab& slab = slabs_[slab_count_++];
    for (int axis = 0; axis < 3; ++axis) {
      slab.direction[axis] = broadcast(static_cast<float>(direction[axis]));
      slab.size[axis] = broadcast(static_cast<float>(std::fabs(direction[axis])));
    }
    slab.lower = broadcast(static_cast<float>(lower) - kSlabSlack - kSlabSlack * static_cast<float>(std::fabs(lower)));
    slab.upper = broadcast(static_cast<float>(upper) + kSlabSlack + kSlabSlack * static_cast<float>(std::fabs(upper)));
  }

  bool usable_ = false;
  Float4 lower_[3], upper_[3];
  std::array<Slab, 4> slabs_;
  std::size_t slab_count_ = 0;
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
