#include "collision/sphere_levels.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "collision/kernels/sphere_block.h"
#include "tree/tree_nodes.h"

// The sphere tests are conservative; placed_trees.cpp, (1) to (4), has the proof.
namespace orchard::runtime {

using detail::block_of;
using detail::BlockHits;
using detail::BlockPair;
using detail::Group;
using detail::group_of;
using detail::is_leaf;

namespace {

constexpr std::size_t kBlockPairs = std::size_t{kBlockWidth} * kBlockWidth;

// Returns a lower bound on the gaps of all pairs that missed. The gap of a pair with the reach s and the excess x is
// sqrt(s^2 + x) - s. This falls with s and grows with x, so with the largest reach and the least excess it is at most
// any of the gaps.
double gap_of(const detail::LevelState& state) noexcept {
  const auto largest = [](const auto& v) { return double{*std::max_element(v.begin(), v.end())}; };
  const double reach = (largest(state.row_radius) + largest(state.lane_radius)) * (1 + 1e-6);
  const double excess = double{*std::min_element(state.min_excess.begin(), state.min_excess.end())};
  return std::isfinite(excess) ? excess / (std::sqrt(reach * reach + excess) + reach)
                               : std::numeric_limits<double>::infinity();
}

}  // namespace

bool SphereLevels::PairList::reserve(std::size_t capacity) noexcept {
  if (capacity <= capacity_) return true;
  capacity = std::max({capacity, 2 * capacity_, std::size_t{64}});
  std::unique_ptr<NodePair[]> larger(new (std::nothrow) NodePair[capacity]);
  if (!larger) return false;
  std::copy_n(pairs_.get(), size_, larger.get());
  pairs_ = std::move(larger);
  capacity_ = capacity;
  return true;
}

bool SphereLevels::reserve(std::size_t pairs) noexcept {
  pairs += kBlockPairs;  // what one pair of blocks may add
  return inner_.reserve(pairs) && leaves_.reserve(pairs) && next_.reserve(pairs);
}

void SphereLevels::clear() noexcept {
  inner_.clear(), leaves_.clear(), next_.clear();
  settled_leaves_ = 0;
}

void SphereLevels::forget(double root_bound) noexcept {
  leaves_.clear(), next_.clear();
  cursor_ = {};
  level_best_ = leaf_best_ = {};
  best_ = {root_bound, {0, 0}};
  least_bound_ = pruned_gap_ = std::numeric_limits<double>::infinity();
}

bool SphereLevels::begin(const PlacedTrees& trees) noexcept {
  if (!inner_.room_for(1) || !leaves_.room_for(1)) return false;
  (roots_are_leaves(trees) ? leaves_ : inner_).push({0, 0});
  start_level(trees);
  settled_leaves_ = leaves_.size();
  return true;
}

bool SphereLevels::roots_are_leaves(const PlacedTrees& trees) noexcept {
  return is_leaf(trees.first().tree, 0) && is_leaf(trees.second().tree, 0);
}

// The two groups of nodes that are compared for a pair: the children of each node, or the node itself if it is a leaf.
struct SphereLevels::Groups {
  Groups(const PlacedTrees& trees, const NodePair& pair) noexcept
      : lanes_are_second(!is_leaf(trees.second().tree, pair.b)),
        row_tree((lanes_are_second ? trees.first() : trees.second()).tree),
        lane_tree((lanes_are_second ? trees.second() : trees.first()).tree),
        rows(group_of(row_tree, (lanes_are_second ? trees.first() : trees.second()).bits,
                      lanes_are_second ? pair.a : pair.b)),
        lanes(group_of(lane_tree, (lanes_are_second ? trees.second() : trees.first()).bits,
                       lanes_are_second ? pair.b : pair.a)) {}

  // Returns up to eight rows and eight lanes, from row `inner` and lane `outer` of the groups on.
  BlockPair block(std::uint32_t outer, std::uint32_t inner) const noexcept {
    const std::uint32_t row = rows.first + inner, lane = lanes.first + outer;
    BlockPair result{&block_of(row_tree, row), &block_of(lane_tree, lane), row % kBlockWidth, 0, 0, lanes_are_second};
    result.lane_count = std::min(kBlockWidth, lanes.count - outer);
    result.row_end = std::min(kBlockWidth, result.row_begin + rows.count - inner);
    return result;
  }
  // Returns the pair that a bit of BlockHits stands for.
  NodePair pair(std::uint32_t outer, std::uint32_t inner, std::uint32_t bit) const noexcept {
    const std::uint32_t row = rows.first + inner;
    const NodePair result{row - row % kBlockWidth + bit / kBlockWidth, lanes.first + outer + bit % kBlockWidth};
    return lanes_are_second ? result : NodePair{result.b, result.a};
  }

  // The lanes are the children of b, and the rows are those of a, or a itself. If b is a leaf, the children of a are
  // the lanes.
  bool lanes_are_second;
  const TreeView &row_tree, &lane_tree;
  Group rows, lanes;
};

SphereLevels::End SphereLevels::refine(const PlacedTrees& trees, PairBudget& tracker) noexcept {
  BlockHits hits;
  for (; cursor_.pair < inner_.size(); ++cursor_.pair, cursor_.outer = 0) {
    const Groups groups(trees, inner_[cursor_.pair]);
    for (; cursor_.outer < groups.lanes.count; cursor_.outer += kBlockWidth, cursor_.inner = 0) {
      while (cursor_.inner < groups.rows.count) {
        if (tracker.exhausted()) return End::budget;
        if (!next_.room_for(kBlockPairs) || !leaves_.room_for(kBlockPairs)) return End::room;
        BlockPair block = groups.block(cursor_.outer, cursor_.inner);
        block.row_end = std::min(block.row_end, block.row_begin + tracker.rows(block.lane_count));
        detail::test_block(block, trees.placement(), seen_, hits);
        collect(trees, groups, hits);
        const std::uint32_t rows = block.row_end - block.row_begin;
        cursor_.inner += rows;
        tests_ += std::uint64_t{rows} * block.lane_count;
        tracker.spend(std::uint64_t{rows} * block.lane_count);
      }
    }
  }
  finish_level(trees);
  return End::level;
}

void SphereLevels::collect(const PlacedTrees& trees, const Groups& groups, const BlockHits& hits) noexcept {
  const auto pair_of = [&](std::uint64_t mask) {
    return groups.pair(cursor_.outer, cursor_.inner, static_cast<std::uint32_t>(std::countr_zero(mask)));
  };
  for (std::uint64_t mask = hits.meeting & ~hits.leaves; mask != 0; mask &= mask - 1) next_.push(pair_of(mask));
  for (std::uint64_t mask = hits.leaves; mask != 0; mask &= mask - 1) leaves_.push(pair_of(mask));
  for (std::uint64_t mask = hits.improving; mask != 0; mask &= mask - 1) {
    const auto bit = static_cast<std::uint32_t>(std::countr_zero(mask));
    improve(trees, pair_of(mask), hits.square[bit / kBlockWidth][bit % kBlockWidth], (hits.leaves >> bit & 1) != 0);
  }
}

void SphereLevels::improve(const PlacedTrees& trees, NodePair pair, double square, bool leaves) noexcept {
  const SiblingBlock &p = block_of(trees.first().tree, pair.a), &q = block_of(trees.second().tree, pair.b);
  const std::uint32_t i = pair.a % kBlockWidth, j = pair.b % kBlockWidth;
  const double slack = trees.placement().slack, scale = trees.relative().scale;
  const double bound = detail::pair_bound(std::sqrt(square) + slack, double{p.radius[i]} + scale * double{q.radius[j]},
                                          double{p.error[i]} + scale * double{q.error[j]},
                                          double{p.depth[i]} + scale * double{q.depth[j]});
  Best& best = leaves ? leaf_best_ : level_best_;
  if (bound >= best.bound) return;
  best = {bound, pair};
  least_bound_ = std::min(least_bound_, bound);
  // The slack covers the rounding of the block's own comparison, so it leaves out no pair that would be accepted here.
  // So the best pair does not depend on how a level is divided into calls.
  (leaves ? seen_.best_leaf : seen_.best_inner) = static_cast<float>(bound + slack);
}

void SphereLevels::start_level(const PlacedTrees& trees) noexcept {
  cursor_ = {};
  level_best_ = {};
  seen_.min_excess.fill(std::numeric_limits<float>::infinity());
  seen_.row_radius.fill(0), seen_.lane_radius.fill(0);
  seen_.best_inner = std::numeric_limits<float>::infinity();
  seen_.best_leaf = static_cast<float>(leaf_best_.bound + double{trees.placement().slack});
}

void SphereLevels::finish_level(const PlacedTrees& trees) noexcept {
  std::swap(inner_, next_);
  next_.clear();
  settled_leaves_ = leaves_.size();
  best_ = leaf_best_.bound <= level_best_.bound ? leaf_best_ : level_best_;
  pruned_gap_ = std::min(pruned_gap_, gap_of(seen_));
  start_level(trees);
}

void SphereLevels::give_up() noexcept {
  inner_.clear();
  next_.clear();
  if (level_best_.bound < best_.bound) best_ = level_best_;
}

}  // namespace orchard::runtime
