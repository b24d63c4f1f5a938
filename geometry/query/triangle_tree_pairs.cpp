#include <algorithm>
#include <cmath>

#include "triangle_tree.h"
#include "triangle_tree_builder.h"

namespace orchard::detail {

// Descends the tree at two places at once, as long as their boxes meet.
class TriangleTree::Pairs {
  // One box, repeated four times.
  struct BoxOfFour {
    Float4 lower[3], upper[3];
    // Sets all bits for each of four boxes that meets this one. An empty box meets none.
    auto meets(const Float4* other_lower, const Float4* other_upper) const {
      auto result = lower[0] <= other_upper[0];
      for (int axis = 0; axis < 3; ++axis)
        result &= (lower[axis] <= other_upper[axis]) & (upper[axis] >= other_lower[axis]);
      return result;
    }
    float size() const {
      float sum = 0;
      for (int axis = 0; axis < 3; ++axis) sum += upper[axis][0] - lower[axis][0];
      return sum;
    }
  };
  struct Place {
    Index child;
    BoxOfFour box;
  };
  // Of the four triangles of a leaf.
  struct LeafBoxes {
    Float4 lower[3], upper[3];
  };

 public:
  Pairs(const TriangleTree& tree, const std::function<void(Index, Index)>& visit) : tree_(tree), visit_(visit) {
    boxes_.reserve(tree.leaves_.size());
    for (const Leaf& leaf : tree.leaves_) boxes_.push_back(boxes_of(leaf));
  }

  void within(Index child) const {
    if (child >= Builder::kLeaf) {
      const Index leaf = child - Builder::kLeaf;
      for (int i = 0; i < 4; ++i) visit_met(leaf, i, leaf, i + 1);
      return;
    }
    const Node& node = tree_.nodes_[child];
    for (int k = 0; k < 4; ++k) {
      if (node.child[k] == kNone) continue;
      within(node.child[k]);
      const Place own = place(node, k);
      const auto meets = own.box.meets(node.lower, node.upper);
      for (int other = k + 1; other < 4; ++other)
        if (meets[other]) between(own, place(node, other));
    }
  }

 private:
  LeafBoxes boxes_of(const Leaf& leaf) const {
    LeafBoxes boxes;
    for (int axis = 0; axis < 3; ++axis) {
      boxes.lower[axis] = broadcast(kFloatInfinity);
      boxes.upper[axis] = broadcast(-kFloatInfinity);
    }
    for (int lane = 0; lane < 4; ++lane) {
      if (leaf.triangle[lane] == kNone) continue;
      for (const Point& corner : tree_.corners(leaf.triangle[lane])) {
        const Point p = tree_.scale_ * (corner - tree_.center_);
        for (int axis = 0; axis < 3; ++axis) {
          boxes.lower[axis][lane] = std::min(boxes.lower[axis][lane], rounded_down(p[axis]));
          boxes.upper[axis][lane] = std::max(boxes.upper[axis][lane], rounded_up(p[axis]));
        }
      }
    }
    return boxes;
  }

  static BoxOfFour one_of(const Float4* lower, const Float4* upper, int lane) {
    BoxOfFour box;
    for (int axis = 0; axis < 3; ++axis) {
      box.lower[axis] = broadcast(lower[axis][lane]);
      box.upper[axis] = broadcast(upper[axis][lane]);
    }
    return box;
  }
  static Place place(const Node& node, int k) { return {node.child[k], one_of(node.lower, node.upper, k)}; }

  // The larger of the two is opened first.
  void between(const Place& a, const Place& b) const {
    const bool a_is_leaf = a.child >= Builder::kLeaf, b_is_leaf = b.child >= Builder::kLeaf;
    if (a_is_leaf && b_is_leaf) {
      for (int i = 0; i < 4; ++i) visit_met(a.child - Builder::kLeaf, i, b.child - Builder::kLeaf, 0);
      return;
    }
    if (a_is_leaf || (!b_is_leaf && b.box.size() > a.box.size())) return between(b, a);
    const Node& node = tree_.nodes_[a.child];
    const auto meets = b.box.meets(node.lower, node.upper);
    for (int k = 0; k < 4; ++k)
      if (meets[k]) between(place(node, k), b);
  }

  // Visits the pairs of one triangle of a leaf with the triangles of a leaf, beginning at a lane.
  void visit_met(Index leaf, int lane, Index other, int from) const {
    const Index triangle = tree_.leaves_[leaf].triangle[lane];
    if (triangle == kNone) return;
    const LeafBoxes &own = boxes_[leaf], &theirs = boxes_[other];
    const auto meets = one_of(own.lower, own.upper, lane).meets(theirs.lower, theirs.upper);
    for (int k = from; k < 4; ++k)
      if (meets[k]) visit_(triangle, tree_.leaves_[other].triangle[k]);
  }

  const TriangleTree& tree_;
  const std::function<void(Index, Index)>& visit_;
  std::vector<LeafBoxes> boxes_;  // in the order of leaves_
};

void TriangleTree::visit_pairs(const std::function<void(Index, Index)>& visit) const { Pairs(*this, visit).within(0); }

}  // namespace orchard::detail
