#include "collision/triangle_search.h"

#include <array>
#include <bit>

namespace orchard::runtime {

using detail::BoxGaps;

bool TriangleSearch::reserve(const PlacedTrees& trees) noexcept {
  // A step replaces two pairs by up to eight children of each. The pairs below them on the stack are no deeper than
  // they were, so no depth ever has more than these.
  return !have_triangles(trees) ||
         stack_.reserve(trees.first().tree, trees.second().tree, 2 * std::size_t{kBlockWidth});
}

// Replaces a pair by those of its children that may meet, the deepest overlap last.
inline void TriangleSearch::push_children(const NodePair& pair, const detail::Opened& opened,
                                          const BoxGaps& gaps) noexcept {
  tests_.pairs += static_cast<std::uint64_t>(std::bit_width(gaps.used));
  stack_.push(
      gaps.meeting, [&](std::uint32_t lane) ORCHARD_INLINE_LAMBDA { return opened.pair(pair, lane); },
      [&](const NodePair&, std::uint32_t lane) ORCHARD_INLINE_LAMBDA { return gaps.gap[lane]; });
}

// Two pairs are opened at a time: while one waits for memory, the processor computes the other one.
bool TriangleSearch::refine(const detail::PlacedViews& trees, PairBudget& tracker) noexcept {
  while (!stack_.empty()) {
    if (tracker.exhausted()) return false;
    const NodePair pair = stack_.pop();
    if (trees.are_leaves(pair)) {
      const std::uint64_t before = tests_.triangles;
      const bool meet = test_leaves(trees, pair);
      tracker.spend((tests_.triangles - before) * kTriangleTestCost);
      if (meet) return true;
      continue;
    }
    const std::uint64_t before = tests_.pairs;
    const detail::Opened opened = trees.open(pair);
    BoxGaps gaps[2];
    trees.meeting_children(pair, opened, gaps[0]);
    if (!stack_.empty() && !trees.are_leaves(stack_.all().back())) {
      const NodePair other = stack_.pop();
      const detail::Opened other_opened = trees.open(other);
      trees.meeting_children(other, other_opened, gaps[1]);
      push_children(other, other_opened, gaps[1]);
    }
    push_children(pair, opened, gaps[0]);
    tracker.spend(tests_.pairs - before);
  }
  return true;
}

bool TriangleSearch::test_leaves(const detail::PlacedViews& trees, const NodePair& pair) noexcept {
  const auto used = [](const TriangleBlock& block) {
    std::uint64_t count = 0;
    for (const std::uint32_t t : block.triangle) count += t != kNoTriangle;
    return count;
  };
  tests_.triangles += used(trees.lanes(pair)) * used(trees.rows(pair));
  return trees.each_candidate(pair, [&](std::uint32_t lane, std::uint32_t row) {
    return test_two(trees, {pair, static_cast<std::uint8_t>(lane), static_cast<std::uint8_t>(row)});
  });
}

bool TriangleSearch::test_two(const detail::PlacedViews& trees, const MeetingTriangles::Place& place) noexcept {
  const TriangleBlock &lanes = trees.lanes(place), &rows = trees.rows(place);
  if (!detail::triangles_intersect(detail::points_of(lanes, place.lane_a),
                                   detail::moved_points_of(rows, place.lane_b, trees.relative), &found_.common)) {
    return false;
  }
  found_.first = lanes.triangle[place.lane_a];
  found_.second = rows.triangle[place.lane_b];
  found_.place = place;
  return true;
}

}  // namespace orchard::runtime
