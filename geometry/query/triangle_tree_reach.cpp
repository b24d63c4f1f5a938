#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "triangle_tree.h"
#include "triangle_tree_builder.h"

namespace orchard::detail {
namespace {

constexpr double kNear = 2;  // sizes of the mesh: for balls that are farther or larger, floats are not accurate enough
constexpr float kBoundSlack = 1e-5f;  // more than the rounding errors of a bound for balls within kNear

}  // namespace

// Bounds how far the balls of a family reach beyond a convex set: a box, slab, plane or triangle. The distance to a
// convex set is a convex function, so it is nowhere below its tangent at the family's middle. The radius minus this
// tangent is linear over the family, so it is largest at one of the three balls.
class TriangleTree::Reach {
 public:
  Reach(const TriangleTree& tree, const std::array<Sphere, 3>& balls, const Point& middle)
      : tree_(tree), balls_(balls), middle_(middle) {
    const Point local = tree.scale_ * (middle - tree.center_);
    double size = local.cwiseAbs().maxCoeff();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector way = tree.scale_ * (balls[k].center - middle);
      const double radius = tree.scale_ * balls[k].radius;
      size = std::max({size, way.cwiseAbs().maxCoeff(), std::abs(radius)});
      radius_[k] = broadcast(static_cast<float>(radius) + kBoundSlack);
      for (int axis = 0; axis < 3; ++axis) way_[k][axis] = broadcast(static_cast<float>(way[axis]));
    }
    usable_ = size < kNear;
    for (int axis = 0; axis < 3; ++axis) place_[axis] = broadcast(static_cast<float>(local[axis]));
  }

  bool usable() const { return usable_; }

  // A bound for each child.
  Float4 bounds(const Node& node) const {
    Float4 from_box[3];
    for (int axis = 0; axis < 3; ++axis)
      from_box[axis] = place_[axis] - min(max(place_[axis], node.lower[axis]), node.upper[axis]);
    const Float4 distance = square_root(dot(from_box, from_box));
    const Float4 inverse = distance > broadcast(0) ? broadcast(1) / distance : broadcast(0);
    for (Float4& component : from_box) component *= inverse;
    const Float4 along = dot(place_, node.normal);
    const Float4 from_slab = along - min(max(along, node.low), node.high);
    return min(beyond(distance, from_box), beyond_plane(from_slab, node.normal));
  }

  // A bound for each triangle of a leaf, by its plane.
  Float4 bounds(const Leaf& leaf) const {
    const Float4 from_origin[3] = {place_[0] - leaf.origin[0], place_[1] - leaf.origin[1], place_[2] - leaf.origin[2]};
    return beyond_plane(dot(from_origin, leaf.n), leaf.n);
  }

  double bound(Index triangle) const {
    const ClosestPoint closest = tree_.measure(middle_, triangle);
    const Vector tangent =
        closest.distance > 0 ? Vector((middle_ - closest.position) / closest.distance) : Vector(Vector::Zero());
    double bound = -std::numeric_limits<double>::infinity();
    for (const Sphere& ball : balls_)
      bound = std::max(bound, ball.radius - closest.distance - tangent.dot(ball.center - middle_));
    return bound;
  }

 private:
  // The bound by a distance from the middle and its gradient, whose length is at most one.
  Float4 beyond(Float4 distance, const Float4* gradient) const {
    Float4 most = broadcast(-kFloatInfinity);
    for (std::size_t k = 0; k < 3; ++k) most = max(most, radius_[k] - dot(gradient, way_[k]));
    return most - distance;
  }
  Float4 beyond_plane(Float4 offset, const Float4* normal) const {
    const Float4 zero = broadcast(0);
    const Float4 side = offset > zero ? broadcast(1) : offset < zero ? broadcast(-1) : zero;
    const Float4 gradient[3] = {side * normal[0], side * normal[1], side * normal[2]};
    return beyond(abs(offset), gradient);
  }

  const TriangleTree& tree_;
  const std::array<Sphere, 3>& balls_;
  const Point& middle_;
  bool usable_ = false;
  // In the tree's coordinates: the middle, the vectors from it to the balls' centres, and the radii plus slack.
  Float4 place_[3];
  Float4 way_[3][3];
  Float4 radius_[3];
};

double TriangleTree::max_reach(const std::array<Sphere, 3>& balls, const Point& middle, double enough) const {
  const Reach reach(*this, balls, middle);
  if (!reach.usable()) return std::numeric_limits<double>::infinity();
  double most = enough;
  float limit = static_cast<float>(scale_ * most);
  const auto raise = [&](double bound) {
    if (!(bound > most)) return;
    most = bound;
    limit = static_cast<float>(scale_ * most);
  };
  struct Entry {
    float bound;
    Index child;
  };
  std::array<Entry, Builder::kStackSize> stack;
  std::size_t top = 0;
  stack[top++] = {kFloatInfinity, 0};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (!(entry.bound > limit)) continue;
    const bool is_leaf = entry.child >= Builder::kLeaf;
    if (is_leaf) {
      const Leaf& leaf = leaves_[entry.child - Builder::kLeaf];
      const Float4 bounds = reach.bounds(leaf);
      for (int k = 0; k < 4; ++k)
        if (bounds[k] > limit && leaf.triangle[k] != kNone) raise(reach.bound(leaf.triangle[k]));
      continue;
    }
    const Node& node = nodes_[entry.child];
    const Float4 bounds = reach.bounds(node);
    const std::size_t first = top;  // the largest is to be popped first
    for (int k = 0; k < 4; ++k) {
      if (node.child[k] == kNone || !(bounds[k] > limit)) continue;
      std::size_t at = top++;
      for (; at > first && stack[at - 1].bound > bounds[k]; --at) stack[at] = stack[at - 1];
      stack[at] = {bounds[k], node.child[k]};
    }
  }
  return most;
}

}  // namespace orchard::detail
