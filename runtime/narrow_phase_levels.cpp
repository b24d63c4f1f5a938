#include <algorithm>
#include <cmath>

#include "orchard/runtime/narrow_phase.h"
#include "tree_nodes.h"

// The levels of the narrow phase. Why the sphere tests are conservative: narrow_phase.cpp, (1) to (4).
namespace orchard::runtime {

using detail::block_of;
using detail::Group;
using detail::group_of;
using detail::is_leaf;

namespace {
constexpr float kFar = 3e18f;  // centre of unused lanes: beyond every reach, and its square is finite
}

class NarrowPhase::Meter {
 public:
  explicit Meter(const Budget& budget) noexcept : limit_(budget.pair_tests) {
    if (budget.time != std::chrono::nanoseconds::max()) {
      timed_ = true;
      deadline_ = std::chrono::steady_clock::now() + budget.time;
    }
  }
  bool exhausted() noexcept { return spent_ >= limit_ || (timed_ && spent_ >= next_look_ && late()); }
  void spend(std::uint64_t tests) noexcept { spent_ += tests; }

 private:
  bool late() noexcept {
    next_look_ = spent_ + kClockInterval;
    return std::chrono::steady_clock::now() >= deadline_;
  }
  std::uint64_t limit_, spent_ = 0, next_look_ = kClockInterval;
  bool timed_ = false;
  std::chrono::steady_clock::time_point deadline_;
};

// Up to eight siblings in the first tree's frame.
struct NarrowPhase::Lanes {
  alignas(32) std::array<float, kBlockWidth> x, y, z, radius;
  const SiblingBlock* block;
  std::uint32_t first, used;
};

struct NarrowPhase::Row {
  float x, y, z, radius;
  const SiblingBlock* block;
  std::uint32_t node;
};

Answer NarrowPhase::refine(const Budget& budget) noexcept {
  if (finished_ || budget.pair_tests == 0) return answer_;
  out_of_memory_ = false;
  if (roots_pending_) {
    if (!reserve(1)) return out_of_memory_ = true, answer_;
    take({0, 0}, inner_);
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

// Pairs of leaves have come as far down as spheres go.
void NarrowPhase::take(NodePair pair, PairList& list) noexcept {
  (is_leaf(*first_.tree, pair.a) && is_leaf(*second_.tree, pair.b) ? leaves_ : list).push(pair);
}

// False if interrupted; cursor_ then says where to go on.
bool NarrowPhase::refine_spheres(Meter& meter) noexcept {
  for (; cursor_.pair < inner_.size(); ++cursor_.pair, cursor_.outer = 0) {
    const auto [a, b] = inner_[cursor_.pair];
    // The lanes are the children of b, the rows those of a, or a itself; if b is a leaf, a's children are the lanes.
    const bool lanes_are_second = !is_leaf(*second_.tree, b);
    const Group rows = lanes_are_second ? group_of(*first_.tree, a) : Group{b, 1};
    const Group columns = lanes_are_second ? group_of(*second_.tree, b) : group_of(*first_.tree, a);
    for (; cursor_.outer < block_count(columns.count); ++cursor_.outer, cursor_.inner = 0) {
      const Lanes lanes = lanes_of(columns, cursor_.outer, lanes_are_second);
      for (; cursor_.inner < rows.count; ++cursor_.inner) {
        if (meter.exhausted()) return false;
        if (!next_.room_for(kBlockWidth) || !leaves_.room_for(kBlockWidth)) return out_of_memory_ = true, false;
        test_row(row_of(rows.first + cursor_.inner, lanes_are_second), lanes, lanes_are_second);
        meter.spend(lanes.used);
      }
    }
  }
  return true;
}

NarrowPhase::Lanes NarrowPhase::lanes_of(Group group, std::uint32_t index, bool of_second) const noexcept {
  const SiblingBlock& block = (of_second ? second_ : first_).tree->blocks[group.first / kBlockWidth + index];
  Lanes lanes;
  lanes.block = &block;
  lanes.first = group.first + index * kBlockWidth;
  lanes.used = std::min(kBlockWidth, group.count - index * kBlockWidth);
  lanes.x = block.x, lanes.y = block.y, lanes.z = block.z, lanes.radius = block.radius;
  if (of_second) {
    const auto& r = rotation_;
    const auto& t = translation_;
    for (std::size_t i = 0; i < kBlockWidth; ++i) {
      lanes.x[i] = r[0] * block.x[i] + r[1] * block.y[i] + r[2] * block.z[i] + t[0];
      lanes.y[i] = r[3] * block.x[i] + r[4] * block.y[i] + r[5] * block.z[i] + t[1];
      lanes.z[i] = r[6] * block.x[i] + r[7] * block.y[i] + r[8] * block.z[i] + t[2];
    }
  }
  for (std::size_t i = lanes.used; i < kBlockWidth; ++i) {
    lanes.x[i] = lanes.y[i] = lanes.z[i] = kFar;
    lanes.radius[i] = 0;
  }
  return lanes;
}

NarrowPhase::Row NarrowPhase::row_of(std::uint32_t node, bool of_first) const noexcept {
  const SiblingBlock& block = block_of(*(of_first ? first_ : second_).tree, node);
  const std::uint32_t lane = node % kBlockWidth;
  const float x = block.x[lane], y = block.y[lane], z = block.z[lane];
  Row row{x, y, z, block.radius[lane] + slack_, &block, node};
  if (!of_first) {
    const auto& r = rotation_;
    const auto& t = translation_;
    row.x = r[0] * x + r[1] * y + r[2] * z + t[0];
    row.y = r[3] * x + r[4] * y + r[5] * z + t[1];
    row.z = r[6] * x + r[7] * y + r[8] * z + t[2];
  }
  return row;
}

void NarrowPhase::test_row(const Row& row, const Lanes& lanes, bool lanes_are_second) noexcept {
  std::array<float, kBlockWidth> square, excess;
  for (std::size_t i = 0; i < kBlockWidth; ++i) {
    const float dx = lanes.x[i] - row.x, dy = lanes.y[i] - row.y, dz = lanes.z[i] - row.z;
    const float reach = row.radius + lanes.radius[i];
    square[i] = dx * dx + dy * dy + dz * dz;
    excess[i] = square[i] - reach * reach;  // > 0 exactly if square > reach * reach
    const float missed = excess[i] > 0 ? excess[i] : std::numeric_limits<float>::infinity();
    level_excess_[i] = missed < level_excess_[i] ? missed : level_excess_[i];
    level_reach_[i] = reach > level_reach_[i] ? reach : level_reach_[i];
  }
  pair_tests_ += lanes.used;
  const std::uint32_t row_lane = row.node % kBlockWidth;
  for (std::uint32_t i = 0; i < lanes.used; ++i) {
    if (excess[i] > 0) continue;
    const std::uint32_t column = lanes.first + i;
    meet(lanes_are_second ? NodePair{row.node, column} : NodePair{column, row.node}, square[i],
         double{row.block->radius[row_lane]} + lanes.block->radius[i],
         double{row.block->error[row_lane]} + lanes.block->error[i],
         double{row.block->depth[row_lane]} + lanes.block->depth[i]);
  }
}

void NarrowPhase::meet(NodePair pair, double square, double radii, double errors, double depths) noexcept {
  const std::size_t leaves = leaves_.size();
  take(pair, next_);
  Best& best = leaves_.size() > leaves ? leaf_best_ : level_best_;
  // Without a square root where the bound cannot improve.
  const double rest = best.bound - depths;
  if (errors >= best.bound && !(rest > 0 && square < rest * rest)) return;
  const double bound = pair_bound(std::sqrt(square) + slack_, radii, errors, depths);
  if (bound >= best.bound) return;
  best = {bound, pair};
  separation_bound_ = std::min(separation_bound_, bound);
}

void NarrowPhase::finish_sphere_level() noexcept {
  ++level_;
  std::swap(inner_, next_);
  next_.clear();
  cursor_ = {};
  settled_leaves_ = leaves_.size();
  best_ = leaf_best_.bound <= level_best_.bound ? leaf_best_ : level_best_;
  level_best_ = {};

  // sqrt(s^2 + x) - s falls with s and grows with x: with the largest reach and the least excess over all the pairs
  // that missed, it is at most any of their gaps.
  const double reach = *std::max_element(level_reach_.begin(), level_reach_.end());
  const double excess = *std::min_element(level_excess_.begin(), level_excess_.end());
  if (std::isfinite(excess)) {
    pruned_gap_ = std::min(pruned_gap_, excess / (std::sqrt(reach * reach + excess) + reach));
  }
  level_excess_.fill(std::numeric_limits<float>::infinity());
  level_reach_.fill(0);

  if (pairs() == 0) {
    finish(Answer::no);
  } else if (inner_.size() == 0 && !has_triangles()) {
    finish(Answer::maybe);
  }
}

// False if interrupted. Ends at the first pair of triangles that meet.
bool NarrowPhase::refine_triangles(Meter& meter) noexcept {
  for (; cursor_.pair < leaves_.size(); ++cursor_.pair, cursor_.outer = 0) {
    const NodePair pair = leaves_[cursor_.pair];
    const auto firsts = detail::triangles_of(*first_.tree, pair.a),
               seconds = detail::triangles_of(*second_.tree, pair.b);
    for (; cursor_.outer < seconds.size(); ++cursor_.outer, cursor_.inner = 0) {
      auto second = detail::points_of(*second_.tree, seconds[cursor_.outer]);
      for (auto& point : second) point = transform(relative_, point);
      for (; cursor_.inner < firsts.size(); ++cursor_.inner) {
        if (meter.exhausted()) return false;
        ++triangle_tests_;
        meter.spend(kTriangleTestCost);
        const auto first = detail::points_of(*first_.tree, firsts[cursor_.inner]);
        if (!detail::triangles_intersect(first, second, &witness_)) continue;
        triangle_first_ = firsts[cursor_.inner];
        triangle_second_ = seconds[cursor_.outer];
        best_.pair = pair;
        return true;
      }
    }
  }
  return true;
}

}  // namespace orchard::runtime
