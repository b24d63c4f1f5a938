#include <array>
#include <bit>

#include "collision/kernels/farthest_first.h"
#include "collision/kernels/node_box.h"
#include "collision/kernels/obb_node_block.h"
#include "collision/pair_query.h"
#include "tree/tree_nodes.h"

// The last level: depth first through the two trees of triangles, the larger ball slab of a pair opened first and the
// deepest overlap looked at first, so that a "yes" comes early.
namespace orchard::runtime {

using detail::BoxGaps;
using detail::slab_block;
using detail::slab_child;

void PairQuery::start_exact() noexcept {
  exact_started_ = true;
  place();
  inner_.clear();
  leaves_.clear();
  next_.clear();
  settled_leaves_ = 0;
  roots_pending_ = false;
  stack_[0] = {0, 0};
  stack_size_ = 1;
}

detail::NodeBox PairQuery::moved_box(std::uint32_t node) const noexcept {
  return detail::moved(detail::node_box_at(second_->tree, node), placement_);
}

// The larger node's children against the other node, in the children's frame. True if they are the second tree's.
inline bool PairQuery::find_children(const NodePair& pair, std::uint32_t a, std::uint32_t b, BoxGaps& gaps) noexcept {
  const ObbNodeBlock &of_a = slab_block(first_->tree, pair.a), &of_b = slab_block(second_->tree, pair.b);
  const std::uint32_t lane_a = pair.a % kBlockWidth, lane_b = pair.b % kBlockWidth;
  const bool second =
      (a & kLeafBit) != 0 || ((b & kLeafBit) == 0 && of_a.radius[lane_a] < of_b.radius[lane_b] * placement_.scale);
  if (second) {
    detail::meeting_boxes(detail::moved_back(detail::node_box_at(of_a, lane_a), placement_), second_->tree.obb_nodes[b],
                          placement_.scale, placement_.box_margin, gaps);
  } else {
    detail::meeting_boxes(moved_box(pair.b), first_->tree.obb_nodes[a], 1, placement_.box_margin, gaps);
  }
  if (placement_.coarse) leave_out_apart(pair, second, second ? b : a, gaps);
  return second;
}

// Of the children of `block` that may meet the other node of the pair as far as floats can say, leaves those out that
// are apart in double.
void PairQuery::leave_out_apart(const NodePair& pair, bool second, std::uint32_t block, BoxGaps& gaps) const noexcept {
  for (std::uint32_t left = gaps.meeting; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    const std::uint32_t child = block * kBlockWidth + lane;
    const bool apart = detail::boxes_are_apart(detail::node_box_at(first_->tree, second ? pair.a : child),
                                               detail::node_box_at(second_->tree, second ? child : pair.b), relative_);
    if (apart) gaps.meeting &= ~(1u << lane);
  }
}

// In place of a pair, those of its children that may meet, the deepest last.
inline void PairQuery::push_children(const NodePair& pair, bool second, std::uint32_t block,
                                     const BoxGaps& gaps) noexcept {
  pair_tests_ += static_cast<std::uint64_t>(std::bit_width(gaps.used));
  std::uint32_t nodes[kBlockWidth];
  detail::FarthestFirst order;
  for (std::uint32_t left = gaps.meeting; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    nodes[order.count] = block * kBlockWidth + lane;
    order.add(gaps.gap[lane]);
  }
  for (std::uint32_t i = 0; i < order.count; ++i) {
    stack_[stack_size_ + order.place[i]] = second ? NodePair{pair.a, nodes[i]} : NodePair{nodes[i], pair.b};
  }
  stack_size_ += order.count;
}

// False if interrupted. Ends at the first pair of triangles that meet.
bool PairQuery::refine_obb_nodes(PairBudget& tracker) noexcept {
  while (stack_size_ > 0) {
    if (tracker.exhausted()) return false;
    const NodePair pair = stack_[--stack_size_];
    const std::uint32_t a = slab_child(first_->tree, pair.a), b = slab_child(second_->tree, pair.b);
    if (a & b & kLeafBit) {
      const std::uint64_t before = triangle_tests_;
      const bool meet = test_triangles(pair);
      tracker.spend((triangle_tests_ - before) * kTriangleTestCost);
      if (meet) return true;
      continue;
    }
    const bool two = stack_size_ > 0 && (slab_child(first_->tree, stack_[stack_size_ - 1].a) &
                                         slab_child(second_->tree, stack_[stack_size_ - 1].b) & kLeafBit) == 0;
    const std::uint64_t before = pair_tests_;
    BoxGaps gaps[2];
    const bool second = find_children(pair, a, b, gaps[0]);
    if (two) {
      const NodePair other = stack_[--stack_size_];
      const std::uint32_t oa = slab_child(first_->tree, other.a), ob = slab_child(second_->tree, other.b);
      const bool other_second = find_children(other, oa, ob, gaps[1]);
      push_children(other, other_second, other_second ? ob : oa, gaps[1]);
    }
    push_children(pair, second, second ? b : a, gaps[0]);
    tracker.spend(pair_tests_ - before);
  }
  return true;
}

// The pairs of what is in the blocks of two leaves, the nearest ones of those that may meet, in place of the roots.
void PairQuery::start_near(const NodePair& leaves) noexcept {
  constexpr std::uint32_t most = kBlockWidth;
  const std::uint32_t block_a = leaves.a / kBlockWidth, block_b = leaves.b / kBlockWidth;
  BoxGaps firsts, seconds;
  detail::meeting_boxes(moved_box(leaves.b), first_->tree.obb_nodes[block_a], 1, placement_.box_margin, firsts);
  std::array<float, most> gaps;
  stack_size_ = 0;
  for (std::uint32_t left = firsts.meeting; left != 0; left &= left - 1) {
    const std::uint32_t a = block_a * kBlockWidth + static_cast<std::uint32_t>(std::countr_zero(left));
    detail::meeting_boxes(detail::moved_back(detail::node_box_at(first_->tree, a), placement_),
                          second_->tree.obb_nodes[block_b], placement_.scale, placement_.box_margin, seconds);
    pair_tests_ += static_cast<std::uint64_t>(std::bit_width(seconds.used));
    for (std::uint32_t lanes = seconds.meeting; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      const NodePair pair = {a, block_b * kBlockWidth + lane};
      if (pair.a == leaves.a && pair.b == leaves.b) continue;
      const float gap = seconds.gap[lane];
      if (stack_size_ == most) {
        if (gap >= gaps[0]) continue;
        for (std::size_t i = 1; i < most; ++i) stack_[i - 1] = stack_[i], gaps[i - 1] = gaps[i];
        --stack_size_;
      }
      std::size_t at = stack_size_++;
      for (; at > 0 && gaps[at - 1] < gap; --at) stack_[at] = stack_[at - 1], gaps[at] = gaps[at - 1];
      stack_[at] = pair, gaps[at] = gap;
    }
  }
}

bool PairQuery::search_near(std::uint32_t a, std::uint32_t b, const Budget& budget) noexcept {
  if (budget.work == 0) return false;
  PairBudget tracker(budget);
  start_exact();
  start_near({a, b});
  const bool ended = refine_obb_nodes(tracker);
  work_ += tracker.spent();
  stack_[0] = {0, 0};
  stack_size_ = 1;
  if (!ended || triangle_first_ == kNoTriangle) return false;
  finish(Answer::yes);
  return true;
}

bool PairQuery::test_triangles(const NodePair& pair) noexcept {
  const TriangleBlock& lanes = first_->tree.triangle_blocks[slab_child(first_->tree, pair.a) & ~kLeafBit];
  const TriangleBlock& rows = second_->tree.triangle_blocks[slab_child(second_->tree, pair.b) & ~kLeafBit];
  const auto used = [](const TriangleBlock& block) {
    std::uint64_t count = 0;
    for (const std::uint32_t t : block.triangle) count += t != kNoTriangle;
    return count;
  };
  triangle_tests_ += used(lanes) * used(rows);
  const detail::NodeBox lane_box = detail::node_box_at(first_->tree, pair.a);
  const detail::NodeBox row_box = moved_box(pair.b);
  struct Leaves {
    PairQuery& self;
    const NodePair& pair;
  } context = {*this, pair};
  const auto any_meets = [](void* of, std::uint32_t row, std::uint32_t left) {
    const auto& [self, nodes] = *static_cast<Leaves*>(of);
    for (; left != 0; left &= left - 1) {
      if (self.triangles_meet(nodes.a, static_cast<std::uint32_t>(std::countr_zero(left)), nodes.b, row)) return true;
    }
    return false;
  };
  return detail::visit_candidates({lanes, rows, lane_box, row_box}, placement_, any_meets, &context);
}

// Of the leaves in these ball slabs, these triangles.
bool PairQuery::triangles_meet(std::uint32_t a, std::uint32_t lane, std::uint32_t b, std::uint32_t row) noexcept {
  const TriangleBlock& lanes = first_->tree.triangle_blocks[slab_child(first_->tree, a) & ~kLeafBit];
  const TriangleBlock& rows = second_->tree.triangle_blocks[slab_child(second_->tree, b) & ~kLeafBit];
  if (!detail::triangles_intersect(detail::points_of(lanes, lane), detail::moved_points_of(rows, row, relative_),
                                   &witness_)) {
    return false;
  }
  triangle_first_ = lanes.triangle[lane];
  triangle_second_ = rows.triangle[row];
  meeting_ = {a, b, static_cast<std::uint8_t>(lane), static_cast<std::uint8_t>(row)};
  return true;
}

}  // namespace orchard::runtime
