#include "collision/triangle_search.h"

#include <array>
#include <bit>

#include "collision/kernels/farthest_first.h"

namespace orchard::runtime {

using detail::BoxGaps;
using detail::slab_child;

bool TriangleSearch::reserve(const PlacedTrees& trees) noexcept {
  // Two expanded pairs leave up to eight each in their place; what lies below them is no deeper than they were, so that
  // no depth ever has more than these.
  return !have_triangles(trees) ||
         stack_.reserve(trees.first().tree, trees.second().tree, 2 * std::size_t{kBlockWidth});
}

void TriangleSearch::start() noexcept {
  stack_[0] = {0, 0};
  size_ = 1;
}

// In place of a pair, those of its children that may meet, the deepest last.
inline void TriangleSearch::push_children(const NodePair& pair, const detail::Opened& opened,
                                          const BoxGaps& gaps) noexcept {
  tests_.pairs += static_cast<std::uint64_t>(std::bit_width(gaps.used));
  size_ = detail::push_farthest_first(
      stack_.data(), size_, gaps.meeting,
      [&](std::uint32_t lane) ORCHARD_INLINE_LAMBDA { return opened.pair(pair, lane); },
      [&](const NodePair&, std::uint32_t lane) ORCHARD_INLINE_LAMBDA { return gaps.gap[lane]; });
}

// Two pairs at a time: what one waits for, the other one computes.
bool TriangleSearch::refine(const PlacedTrees& trees, PairBudget& tracker) noexcept {
  const TreeView &first = trees.first().tree, &second = trees.second().tree;
  const detail::Placement& placement = trees.placement();
  const auto open = [&](const NodePair& pair, std::uint32_t a, std::uint32_t b, BoxGaps& gaps) ORCHARD_INLINE_LAMBDA {
    const detail::Opened opened = detail::larger_node(first, second, pair, a, b, placement.scale);
    detail::meeting_children(first, second, placement, trees.relative(), pair, opened, gaps);
    return opened;
  };
  while (size_ > 0) {
    if (tracker.exhausted()) return false;
    const NodePair pair = stack_[--size_];
    const std::uint32_t a = slab_child(first, pair.a), b = slab_child(second, pair.b);
    if (a & b & kLeafBit) {
      const std::uint64_t before = tests_.triangles;
      const bool meet = test_leaves(trees, pair);
      tracker.spend((tests_.triangles - before) * kTriangleTestCost);
      if (meet) return true;
      continue;
    }
    const bool two =
        size_ > 0 && (slab_child(first, stack_[size_ - 1].a) & slab_child(second, stack_[size_ - 1].b) & kLeafBit) == 0;
    const std::uint64_t before = tests_.pairs;
    BoxGaps gaps[2];
    const detail::Opened opened = open(pair, a, b, gaps[0]);
    if (two) {
      const NodePair other = stack_[--size_];
      const detail::Opened other_opened = open(other, slab_child(first, other.a), slab_child(second, other.b), gaps[1]);
      push_children(other, other_opened, gaps[1]);
    }
    push_children(pair, opened, gaps[0]);
    tracker.spend(tests_.pairs - before);
  }
  return true;
}

void TriangleSearch::start_near(const PlacedTrees& trees, const NodePair& leaves) noexcept {
  constexpr std::uint32_t most = kBlockWidth;
  const TreeView &first = trees.first().tree, &second = trees.second().tree;
  const detail::Placement& placement = trees.placement();
  const std::uint32_t block_a = leaves.a / kBlockWidth, block_b = leaves.b / kBlockWidth;
  BoxGaps firsts, seconds;
  detail::box_gaps(moved_box(trees, leaves.b), first.obb_nodes[block_a], 1, placement.box_margin, firsts);
  std::array<float, most> gaps;
  size_ = 0;
  for (std::uint32_t left = firsts.meeting; left != 0; left &= left - 1) {
    const std::uint32_t a = block_a * kBlockWidth + static_cast<std::uint32_t>(std::countr_zero(left));
    detail::box_gaps(detail::moved_back(detail::node_box_at(first, a), placement), second.obb_nodes[block_b],
                     placement.scale, placement.box_margin, seconds);
    tests_.pairs += static_cast<std::uint64_t>(std::bit_width(seconds.used));
    for (std::uint32_t lanes = seconds.meeting; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      const NodePair pair = {a, block_b * kBlockWidth + lane};
      if (pair.a == leaves.a && pair.b == leaves.b) continue;
      const float gap = seconds.gap[lane];
      if (size_ == most) {
        if (gap >= gaps[0]) continue;
        for (std::size_t i = 1; i < most; ++i) stack_[i - 1] = stack_[i], gaps[i - 1] = gaps[i];
        --size_;
      }
      std::size_t at = size_++;
      for (; at > 0 && gaps[at - 1] < gap; --at) stack_[at] = stack_[at - 1], gaps[at] = gaps[at - 1];
      stack_[at] = pair, gaps[at] = gap;
    }
  }
}

bool TriangleSearch::test_leaves(const PlacedTrees& trees, const NodePair& pair) noexcept {
  const TreeView &first = trees.first().tree, &second = trees.second().tree;
  const TriangleBlock& lanes = first.triangle_blocks[slab_child(first, pair.a) & ~kLeafBit];
  const TriangleBlock& rows = second.triangle_blocks[slab_child(second, pair.b) & ~kLeafBit];
  const auto used = [](const TriangleBlock& block) {
    std::uint64_t count = 0;
    for (const std::uint32_t t : block.triangle) count += t != kNoTriangle;
    return count;
  };
  tests_.triangles += used(lanes) * used(rows);
  const detail::NodeBox lane_box = detail::node_box_at(first, pair.a);
  const detail::NodeBox row_box = moved_box(trees, pair.b);
  const auto meet = [&](std::uint32_t lane, std::uint32_t row) {
    return test_two(trees, {pair.a, pair.b, static_cast<std::uint8_t>(lane), static_cast<std::uint8_t>(row)});
  };
  return detail::each_candidate({lanes, rows, lane_box, row_box}, trees.placement(), meet);
}

bool TriangleSearch::test_two(const PlacedTrees& trees, const MeetingTriangles::Place& place) noexcept {
  const TreeView &first = trees.first().tree, &second = trees.second().tree;
  const TriangleBlock& lanes = first.triangle_blocks[slab_child(first, place.first) & ~kLeafBit];
  const TriangleBlock& rows = second.triangle_blocks[slab_child(second, place.second) & ~kLeafBit];
  if (!detail::triangles_intersect(detail::points_of(lanes, place.lane_first),
                                   detail::moved_points_of(rows, place.lane_second, trees.relative()),
                                   &found_.common)) {
    return false;
  }
  found_.first = lanes.triangle[place.lane_first];
  found_.second = rows.triangle[place.lane_second];
  found_.place = place;
  return true;
}

}  // namespace orchard::runtime
