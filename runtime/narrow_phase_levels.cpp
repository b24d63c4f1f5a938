#include <algorithm>
#include <bit>
#include <cmath>

#include "orchard/runtime/narrow_phase.h"
#include "sphere_block.h"
#include "tree_nodes.h"
#include "triangle_block.h"

// The levels of the narrow phase. Why the sphere tests are conservative: narrow_phase.cpp, (1) to (4).
namespace orchard::runtime {

using detail::block_of;
using detail::BlockHits;
using detail::BlockPair;
using detail::Group;
using detail::group_of;
using detail::is_leaf;
using detail::kTriangleWidth;
using detail::length;
using detail::TriangleBlock;

namespace {
constexpr std::size_t kBlockPairs = std::size_t{kBlockWidth} * kBlockWidth;
}

class NarrowPhase::Meter {
 public:
  explicit Meter(const Budget& budget) noexcept : limit_(budget.pair_tests) {
    if (budget.time < std::chrono::hours(24 * 365)) {  // more is no limit, and would overflow the clock
      next_look_ = kClockInterval;
      deadline_ = std::chrono::steady_clock::now() + budget.time;
    }
  }
  bool exhausted() noexcept { return spent_ >= limit_ || (spent_ >= next_look_ && late()); }
  // How many rows of so many tests may follow before the next look at the limits: at least one.
  std::uint32_t rows(std::uint32_t tests) const noexcept {
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(kBlockWidth, (std::min(limit_, next_look_) - spent_ - 1) / tests + 1));
  }
  void spend(std::uint64_t tests) noexcept { spent_ += tests; }

 private:
  bool late() noexcept {
    next_look_ = spent_ + kClockInterval;
    return std::chrono::steady_clock::now() >= deadline_;
  }
  std::uint64_t limit_, spent_ = 0, next_look_ = std::numeric_limits<std::uint64_t>::max();
  std::chrono::steady_clock::time_point deadline_;
};

Answer NarrowPhase::refine(const Budget& budget) noexcept {
  if (finished_ || budget.pair_tests == 0) return answer_;
  out_of_memory_ = false;
  if (roots_pending_) {
    if (!reserve(1)) return out_of_memory_ = true, answer_;
    (is_leaf(*first_.tree, 0) && is_leaf(*second_.tree, 0) ? leaves_ : inner_).push({0, 0});
    start_level();
    settled_leaves_ = leaves_.size();
    roots_pending_ = false;
  }
  Meter meter(budget);
  if (inner_.size() > 0) {
    if (refine_spheres(meter)) finish_sphere_level();
  } else if (refine_triangles(meter)) {
    ++level_;
    finish(triangle_first_ == kNoTriangle ? Answer::no : Answer::yes);
  }
  return answer_;
}

// False if interrupted; cursor_ then says where to go on.
bool NarrowPhase::refine_spheres(Meter& meter) noexcept {
  BlockHits hits;
  for (; cursor_.pair < inner_.size(); ++cursor_.pair, cursor_.outer = 0) {
    const auto [a, b] = inner_[cursor_.pair];
    // The lanes are the children of b, the rows those of a, or a itself; if b is a leaf, a's children are the lanes.
    const bool lanes_are_second = !is_leaf(*second_.tree, b);
    const PackedSphereTree& row_tree = *(lanes_are_second ? first_ : second_).tree;
    const PackedSphereTree& lane_tree = *(lanes_are_second ? second_ : first_).tree;
    const Group rows = group_of(row_tree, lanes_are_second ? a : b);
    const Group lanes = group_of(lane_tree, lanes_are_second ? b : a);
    for (; cursor_.outer < lanes.count; cursor_.outer += kBlockWidth, cursor_.inner = 0) {
      while (cursor_.inner < rows.count) {
        if (meter.exhausted()) return false;
        if (!next_.room_for(kBlockPairs) || !leaves_.room_for(kBlockPairs)) {
          return out_of_memory_ = true, false;
        }
        const std::uint32_t row = rows.first + cursor_.inner, lane = lanes.first + cursor_.outer;
        BlockPair block{&block_of(row_tree, row), &block_of(lane_tree, lane), row % kBlockWidth, 0, 0,
                        lanes_are_second};
        block.lane_count = std::min(kBlockWidth, lanes.count - cursor_.outer);
        block.row_end = std::min(kBlockWidth, block.row_begin + rows.count - cursor_.inner);
        block.row_end = std::min(block.row_end, block.row_begin + meter.rows(block.lane_count));
        detail::test_block(block, placement_, level_state_, hits);
        const std::uint32_t tested = block.row_end - block.row_begin;
        collect(row - block.row_begin, lane, hits, lanes_are_second);
        cursor_.inner += tested;
        pair_tests_ += std::uint64_t{tested} * block.lane_count;
        meter.spend(std::uint64_t{tested} * block.lane_count);
      }
    }
  }
  return true;
}

void NarrowPhase::collect(std::uint32_t row, std::uint32_t lane, const BlockHits& hits,
                          bool lanes_are_second) noexcept {
  const auto pair_of = [=](std::uint64_t mask) {
    const auto bit = static_cast<std::uint32_t>(std::countr_zero(mask));
    const NodePair pair{row + bit / kBlockWidth, lane + bit % kBlockWidth};
    return lanes_are_second ? pair : NodePair{pair.b, pair.a};
  };
  for (std::uint64_t mask = hits.meeting & ~hits.leaves; mask != 0; mask &= mask - 1) next_.push(pair_of(mask));
  for (std::uint64_t mask = hits.leaves; mask != 0; mask &= mask - 1) leaves_.push(pair_of(mask));
  for (std::uint64_t mask = hits.improving; mask != 0; mask &= mask - 1) {
    const auto bit = static_cast<std::uint32_t>(std::countr_zero(mask));
    improve(pair_of(mask), hits.square[bit / kBlockWidth][bit % kBlockWidth], (hits.leaves >> bit & 1) != 0);
  }
}

void NarrowPhase::improve(NodePair pair, double square, bool leaves) noexcept {
  const SiblingBlock &p = block_of(*first_.tree, pair.a), &q = block_of(*second_.tree, pair.b);
  const std::uint32_t i = pair.a % kBlockWidth, j = pair.b % kBlockWidth;
  const double slack = placement_.slack;
  const double bound = pair_bound(std::sqrt(square) + slack, double{p.radius[i]} + q.radius[j],
                                  double{p.error[i]} + q.error[j], double{p.depth[i]} + q.depth[j]);
  Best& best = leaves ? leaf_best_ : level_best_;
  if (bound >= best.bound) return;
  best = {bound, pair};
  separation_bound_ = std::min(separation_bound_, bound);
  // Slack covers the rounding of the block's own comparison: a pair that would be taken here is never withheld, so what
  // is best does not depend on how the level was cut into calls.
  (leaves ? level_state_.best_leaf : level_state_.best_inner) = static_cast<float>(bound + slack);
}

void NarrowPhase::start_level() noexcept {
  cursor_ = {};
  level_best_ = {};
  level_state_.least_excess.fill(std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()) - 1);
  level_state_.row_radius.fill(0);
  level_state_.lane_radius.fill(0);
  level_state_.best_inner = std::numeric_limits<float>::infinity();
  level_state_.best_leaf = static_cast<float>(leaf_best_.bound + double{placement_.slack});
}

void NarrowPhase::finish_sphere_level() noexcept {
  ++level_;
  std::swap(inner_, next_);
  next_.clear();
  settled_leaves_ = leaves_.size();
  best_ = leaf_best_.bound <= level_best_.bound ? leaf_best_ : level_best_;

  // sqrt(s^2 + x) - s falls with s and grows with x: with the largest reach and the least excess over all the pairs
  // that missed, it is at most any of their gaps.
  const auto largest = [](const auto& v) { return double{*std::max_element(v.begin(), v.end())}; };
  const double reach = (largest(level_state_.row_radius) + largest(level_state_.lane_radius)) * (1 + 1e-6);
  const auto& least = level_state_.least_excess;
  const double excess = std::bit_cast<float>(*std::min_element(least.begin(), least.end()) + 1);
  if (std::isfinite(excess)) {
    pruned_gap_ = std::min(pruned_gap_, excess / (std::sqrt(reach * reach + excess) + reach));
  }
  start_level();
  if (pairs() == 0) {
    finish(Answer::no);
  } else if (inner_.size() == 0 && !has_triangles()) {
    finish(Answer::maybe);
  }
}

namespace {

// The blocks of the leaves seen last: the pairs come in runs of one first leaf with several second siblings, again and
// again the same ones.
class BlockCache {
 public:
  BlockCache(const PackedSphereTree& tree, const Pose* pose) noexcept : tree_(tree), pose_(pose) {
    keys_.fill({kNoNode, 0});
  }

  const TriangleBlock& get(std::uint32_t leaf, std::span<const std::uint32_t> triangles,
                           std::uint32_t offset) noexcept {
    const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(kTriangleWidth, triangles.size() - offset));
    const std::size_t slot = leaf % kBlockWidth;
    if (keys_[slot] != std::pair{leaf, offset}) {
      keys_[slot] = {leaf, offset};
      detail::load_block(tree_, triangles.data() + offset, count, pose_, blocks_[slot]);
    }
    return blocks_[slot];
  }

 private:
  static constexpr std::uint32_t kNoNode = ~0u;
  const PackedSphereTree& tree_;
  const Pose* pose_;
  std::array<std::pair<std::uint32_t, std::uint32_t>, kBlockWidth> keys_;
  std::array<TriangleBlock, kBlockWidth> blocks_;
};

}  // namespace

// False if interrupted. Ends at the first pair of triangles that meet.
bool NarrowPhase::refine_triangles(Meter& meter) noexcept {
  BlockCache firsts(*first_.tree, nullptr), seconds(*second_.tree, &relative_);
  const double size = first_.extent + second_.extent + length(relative_.translation);
  const auto ball_of = [this](const PackedSphereTree& tree, std::uint32_t leaf) {
    const double radius = block_of(tree, leaf).radius[leaf % kBlockWidth];
    return detail::Ball{detail::center_of(tree, leaf), radius + placement_.slack};
  };
  for (; cursor_.pair < leaves_.size(); ++cursor_.pair, cursor_.outer = 0) {
    const NodePair pair = leaves_[cursor_.pair];
    const auto columns = detail::triangles_of(*first_.tree, pair.a), rows = detail::triangles_of(*second_.tree, pair.b);
    const detail::Ball first_ball = ball_of(*first_.tree, pair.a);
    detail::Ball second_ball = ball_of(*second_.tree, pair.b);
    second_ball.center = transform(relative_, second_ball.center);
    for (; cursor_.outer < columns.size(); cursor_.outer += kTriangleWidth, cursor_.inner = 0) {
      while (cursor_.inner < rows.size()) {
        if (meter.exhausted()) return false;
        const TriangleBlock& lanes = firsts.get(pair.a, columns, cursor_.outer);
        const TriangleBlock& others = seconds.get(pair.b, rows, cursor_.inner / kTriangleWidth * kTriangleWidth);
        const std::uint32_t begin = cursor_.inner % kTriangleWidth, cost = lanes.count * kTriangleTestCost;
        const std::uint32_t end = std::min(others.count, begin + meter.rows(cost));
        const std::uint32_t found = detail::candidates({others, lanes, begin, end, second_ball, first_ball, size});
        const bool meet = settle(lanes, others, found);
        // Rows after the one that decides do not count, or the count would depend on how the level was cut.
        const std::uint32_t tested = (meet ? triangle_second_ + 1 : end) - begin;
        triangle_tests_ += std::uint64_t{lanes.count} * tested;
        meter.spend(std::uint64_t{cost} * tested);
        cursor_.inner += tested;
        if (!meet) continue;
        triangle_first_ = columns[cursor_.outer + triangle_first_];
        triangle_second_ = rows[cursor_.inner - 1];
        best_.pair = pair;
        return true;
      }
    }
  }
  return true;
}

// Leaves the lanes of the first pair that meets in triangle_first_ and triangle_second_.
bool NarrowPhase::settle(const TriangleBlock& lanes, const TriangleBlock& rows, std::uint32_t candidates) noexcept {
  for (; candidates != 0; candidates &= candidates - 1) {
    const auto bit = static_cast<std::uint32_t>(std::countr_zero(candidates));
    const std::uint32_t row = bit / kTriangleWidth, lane = bit % kTriangleWidth;
    if (!detail::triangles_intersect(lanes.points(lane), rows.points(row), &witness_)) continue;
    triangle_first_ = lane;
    triangle_second_ = row;
    return true;
  }
  return false;
}

}  // namespace orchard::runtime
