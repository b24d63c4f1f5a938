#include <algorithm>
#include <bit>
#include <cmath>

#include "collision/kernels/sphere_block.h"
#include "collision/pair_query.h"
#include "tree/tree_nodes.h"

// The levels of the narrow phase. Why the sphere tests are conservative: pair_query.cpp, (1) to (4).
namespace orchard::runtime {

using detail::block_of;
using detail::BlockHits;
using detail::BlockPair;
using detail::Group;
using detail::group_of;
using detail::is_leaf;

namespace {

constexpr std::size_t kBlockPairs = std::size_t{kBlockWidth} * kBlockWidth;
constexpr std::uint32_t kMaxProbedLevels = 64;  // a call each
constexpr std::uint32_t kNoExcess = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()) - 1;

// sqrt(s^2 + x) - s falls with s and grows with x: with the largest reach and the least excess over all the pairs that
// missed, it is at most any of their gaps.
double gap_of(const detail::LevelState& state) noexcept {
  const auto largest = [](const auto& v) { return double{*std::max_element(v.begin(), v.end())}; };
  const double reach = (largest(state.row_radius) + largest(state.lane_radius)) * (1 + 1e-6);
  const double excess =
      double{std::bit_cast<float>(*std::min_element(state.min_excess.begin(), state.min_excess.end()) + 1)};
  return std::isfinite(excess) ? excess / (std::sqrt(reach * reach + excess) + reach)
                               : std::numeric_limits<double>::infinity();
}

// The pair among `bits` whose spheres overlap most, compared with their sizes.
std::uint32_t deepest_of(std::uint64_t bits, const BlockPair& block, const BlockHits& hits, float scale) noexcept {
  auto best = static_cast<std::uint32_t>(std::countr_zero(bits));
  float least = std::numeric_limits<float>::infinity();
  const float row_scale = block.lanes_are_second ? 1.0f : scale, lane_scale = block.lanes_are_second ? scale : 1.0f;
  for (; bits != 0; bits &= bits - 1) {
    const auto bit = static_cast<std::uint32_t>(std::countr_zero(bits));
    const std::uint32_t row = bit / kBlockWidth, lane = bit % kBlockWidth;
    const float reach = block.rows->radius[row] * row_scale + block.lanes->radius[lane] * lane_scale;
    const float depth = hits.square[row][lane] - reach * reach;
    if (depth < least) least = depth, best = bit;
  }
  return best;
}

}  // namespace

Answer PairQuery::refine_level(const Budget& budget) noexcept {
  if (budget.work == 0) return answer_;
  if (roots_pending_) {
    place();
    roots_pending_ = false;
    if (!inner_.room_for(1) || !leaves_.room_for(1)) return give_up_spheres(), answer_;
    (is_leaf(first_->tree, 0) && is_leaf(second_->tree, 0) ? leaves_ : inner_).push({0, 0});
    start_level();
    settled_leaves_ = leaves_.size();
  }
  if (inner_.size() == 0) return refine_exactly(budget);
  PairBudget tracker(budget);
  if (refine_spheres(tracker)) finish_sphere_level();
  work_ += tracker.spent();
  return answer_;
}

Answer PairQuery::refine_last(const Budget& budget) noexcept {
  if (budget.work == 0) return answer_;
  if (!has_last_level()) return refine(budget);
  PairBudget tracker(budget);
  if (!exact_started_) {
    start_exact();
  }
  if (refine_obb_nodes(tracker)) {
    ++level_;
    finish(triangle_first_ == kNoTriangle ? Answer::no : Answer::yes);
  }
  work_ += tracker.spent();
  return answer_;
}

// False if interrupted; cursor_ then says where to go on.
bool PairQuery::refine_spheres(PairBudget& tracker) noexcept {
  BlockHits hits;
  for (; cursor_.pair < inner_.size(); ++cursor_.pair, cursor_.outer = 0) {
    const auto [a, b] = inner_[cursor_.pair];
    // The lanes are the children of b, the rows those of a, or a itself; if b is a leaf, a's children are the lanes.
    const bool lanes_are_second = !is_leaf(second_->tree, b);
    const Side &row_side = lanes_are_second ? *first_ : *second_, &lane_side = lanes_are_second ? *second_ : *first_;
    const Group rows = group_of(row_side.tree, row_side.bits, lanes_are_second ? a : b);
    const Group lanes = group_of(lane_side.tree, lane_side.bits, lanes_are_second ? b : a);
    for (; cursor_.outer < lanes.count; cursor_.outer += kBlockWidth, cursor_.inner = 0) {
      while (cursor_.inner < rows.count) {
        if (tracker.exhausted()) return false;
        if (!next_.room_for(kBlockPairs) || !leaves_.room_for(kBlockPairs)) {
          give_up_spheres();
          return false;
        }
        const std::uint32_t row = rows.first + cursor_.inner, lane = lanes.first + cursor_.outer;
        BlockPair block{
            &block_of(row_side.tree, row), &block_of(lane_side.tree, lane), row % kBlockWidth, 0, 0, lanes_are_second};
        block.lane_count = std::min(kBlockWidth, lanes.count - cursor_.outer);
        block.row_end = std::min(kBlockWidth, block.row_begin + rows.count - cursor_.inner);
        block.row_end = std::min(block.row_end, block.row_begin + tracker.rows(block.lane_count));
        detail::test_block(block, placement_, level_state_, hits);
        const std::uint32_t tested = block.row_end - block.row_begin;
        collect(row - block.row_begin, lane, hits, lanes_are_second);
        cursor_.inner += tested;
        pair_tests_ += std::uint64_t{tested} * block.lane_count;
        tracker.spend(std::uint64_t{tested} * block.lane_count);
      }
    }
  }
  return true;
}

void PairQuery::collect(std::uint32_t row, std::uint32_t lane, const BlockHits& hits, bool lanes_are_second) noexcept {
  const auto pair_of = [=](std::uint64_t mask) {
    return pair_at(row, lane, static_cast<std::uint32_t>(std::countr_zero(mask)), lanes_are_second);
  };
  for (std::uint64_t mask = hits.meeting & ~hits.leaves; mask != 0; mask &= mask - 1) next_.push(pair_of(mask));
  for (std::uint64_t mask = hits.leaves; mask != 0; mask &= mask - 1) leaves_.push(pair_of(mask));
  for (std::uint64_t mask = hits.improving; mask != 0; mask &= mask - 1) {
    const auto bit = static_cast<std::uint32_t>(std::countr_zero(mask));
    improve(pair_of(mask), hits.square[bit / kBlockWidth][bit % kBlockWidth], (hits.leaves >> bit & 1) != 0);
  }
}

void PairQuery::improve(NodePair pair, double square, bool leaves) noexcept {
  const SiblingBlock &p = block_of(first_->tree, pair.a), &q = block_of(second_->tree, pair.b);
  const std::uint32_t i = pair.a % kBlockWidth, j = pair.b % kBlockWidth;
  const double slack = placement_.slack;
  const double scale = relative_.scale;
  const double bound = detail::pair_bound(std::sqrt(square) + slack, double{p.radius[i]} + scale * double{q.radius[j]},
                                          double{p.error[i]} + scale * double{q.error[j]},
                                          double{p.depth[i]} + scale * double{q.depth[j]});
  Best& best = leaves ? leaf_best_ : level_best_;
  if (bound >= best.bound) return;
  best = {bound, pair};
  separation_bound_ = std::min(separation_bound_, bound * first_pose_.scale);
  // Slack covers the rounding of the block's own comparison: a pair that would be taken here is never withheld, so what
  // is best does not depend on how the level was cut into calls.
  (leaves ? level_state_.best_leaf : level_state_.best_inner) = static_cast<float>(bound + slack);
}

void PairQuery::start_level() noexcept {
  cursor_ = {};
  level_best_ = {};
  level_state_.min_excess.fill(kNoExcess);
  level_state_.row_radius.fill(0);
  level_state_.lane_radius.fill(0);
  level_state_.best_inner = std::numeric_limits<float>::infinity();
  level_state_.best_leaf = static_cast<float>(leaf_best_.bound + double{placement_.slack});
}

void PairQuery::finish_sphere_level() noexcept {
  ++level_;
  std::swap(inner_, next_);
  next_.clear();
  settled_leaves_ = leaves_.size();
  best_ = leaf_best_.bound <= level_best_.bound ? leaf_best_ : level_best_;

  pruned_gap_ = std::min(pruned_gap_, gap_of(level_state_) * first_pose_.scale);
  start_level();
  if (pairs() == 0) {
    finish(Answer::no);
  } else if (inner_.size() == 0 && !has_last_level()) {
    finish(Answer::maybe);
  }
}

// What a depth-first search has seen; its tests count for a lower bound as those of a level do.
struct PairQuery::Probe {
  detail::LevelState seen;
  NodePair found{};
  double square = 0;
};

Answer PairQuery::probe(std::uint32_t level) noexcept {
  if (finished_ || !roots_pending_) return answer_;
  place();
  Probe probe{};
  probe.seen.min_excess.fill(kNoExcess);
  const bool leaves = is_leaf(first_->tree, 0) && is_leaf(second_->tree, 0);
  if (leaves || level == 0) return answer_;
  level_best_ = {};
  if (probe_below({0, 0}, std::min(level, kMaxProbedLevels), probe)) {
    improve(probe.found, probe.square, false);
    if (level_best_.bound < best_.bound) best_ = level_best_;
    return answer_;
  }
  pruned_gap_ = std::min(pruned_gap_, gap_of(probe.seen) * first_pose_.scale);
  level_ = level;
  finish(Answer::no);
  return answer_;
}

// The pair's children, the deepest overlap first. True once two nodes meet that are that many levels down, or leaves.
bool PairQuery::probe_below(NodePair pair, std::uint32_t levels, Probe& probe) noexcept {
  const bool lanes_are_second = !is_leaf(second_->tree, pair.b);
  const Side &row_side = lanes_are_second ? *first_ : *second_, &lane_side = lanes_are_second ? *second_ : *first_;
  const Group rows = group_of(row_side.tree, row_side.bits, lanes_are_second ? pair.a : pair.b);
  const Group lanes = group_of(lane_side.tree, lane_side.bits, lanes_are_second ? pair.b : pair.a);
  BlockHits hits;
  for (std::uint32_t outer = 0; outer < lanes.count; outer += kBlockWidth) {
    for (std::uint32_t inner = 0; inner < rows.count;) {
      const std::uint32_t row = rows.first + inner, lane = lanes.first + outer;
      BlockPair block{
          &block_of(row_side.tree, row), &block_of(lane_side.tree, lane), row % kBlockWidth, 0, 0, lanes_are_second};
      block.lane_count = std::min(kBlockWidth, lanes.count - outer);
      block.row_end = std::min(kBlockWidth, block.row_begin + rows.count - inner);
      detail::test_block(block, placement_, probe.seen, hits);
      pair_tests_ += std::uint64_t{block.row_end - block.row_begin} * block.lane_count;
      inner += block.row_end - block.row_begin;
      for (std::uint64_t left = levels > 1 && hits.leaves == 0 ? hits.meeting : 0; left != 0;) {
        const std::uint32_t bit = deepest_of(left, block, hits, placement_.scale);
        left &= ~(std::uint64_t{1} << bit);
        const NodePair deeper = pair_at(row - block.row_begin, lane, bit, lanes_are_second);
        if (probe_below(deeper, levels - 1, probe)) return true;
      }
      const std::uint64_t ends = levels > 1 ? hits.leaves : hits.meeting;
      if (ends == 0) continue;
      const std::uint32_t bit = deepest_of(ends, block, hits, placement_.scale);
      probe.found = pair_at(row - block.row_begin, lane, bit, lanes_are_second);
      probe.square = double{hits.square[bit / kBlockWidth][bit % kBlockWidth]};
      return true;
    }
  }
  return false;
}

// The bounds so far stay valid.
void PairQuery::give_up_spheres() noexcept {
  out_of_room_ = true;
  inner_.clear();
  next_.clear();
  best_ = level_best_.bound < best_.bound ? level_best_ : best_;
  if (!has_last_level()) finish(Answer::maybe);
}

}  // namespace orchard::runtime
