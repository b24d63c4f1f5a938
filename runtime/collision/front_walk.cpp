#include "collision/front_walk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "collision/kernels/farthest_first.h"
#include "math/vector_functions.h"

// Rounding of gaps that close. A gap was certified, rounding included, for the second body as the double pose placed it
// then. Since then a point x of it has moved by (turn x + by), which is known to within 20 u D for numbers rounded to
// float, u = 2^-24 and D as in placed_trees.cpp, now or then; vectors are of length 1 to within 1e-6; and taking the
// sum from the gap costs u of it. Placement::margin is more than 96 u D of now, and D then is at most D now and the
// motion.
namespace orchard::runtime {

using detail::BoxAxes;
using detail::LeafAxis;

namespace {

constexpr float kUnused = std::numeric_limits<float>::infinity();
constexpr float kUnknown = -kUnused;  // of a gap: whatever the motion
constexpr float kFarSteps = 16;  // last motions: what is farther than these is kept as one bound where room is short
constexpr std::uint32_t kMostOpen = 64;  // more to look at than that, and the roots are the shorter way
constexpr double kAxisError = 4e-6;      // of a motion

}  // namespace

FrontWalk::FrontWalk(PairFront& front, DirectSearch& search) noexcept
    : front_(front),
      search_(search),
      first_(search.trees().first().tree),
      second_(search.trees().second().tree),
      placement_(search.trees().placement()),
      relative_(search.trees().relative()),
      stack_(search.stack()) {}

void FrontWalk::run(const Budget& budget) noexcept {
  PairBudget tracker(budget);
  tracker_ = &tracker;
  Outcome outcome = settle_leaves();
  if (outcome == Outcome::apart) outcome = settle_nodes();
  tracker_ = nullptr;
  search_.add_work(tracker.spent());
  if (outcome != Outcome::apart) return;
  const double scale = search_.trees().first_pose().scale;
  const double least = std::min(front_.rest_, double{least_});
  search_.say_no(std::max(0.0, least * scale * (1 - 1e-12) - search_.trees().exact_error()));
}

bool FrontWalk::fits() const noexcept {
  return front_.first_ == first_.obb_nodes.data() && front_.second_ == second_.obb_nodes.data() &&
         front_.fingerprints_[0] == search_.trees().first().fingerprint &&
         front_.fingerprints_[1] == search_.trees().second().fingerprint;
}

void FrontWalk::begin() noexcept {
  front_.first_ = first_.obb_nodes.data(), front_.second_ = second_.obb_nodes.data();
  front_.fingerprints_[0] = search_.trees().first().fingerprint;
  front_.fingerprints_[1] = search_.trees().second().fingerprint;
  front_.relative_ = relative_;
  front_.rest_ = std::numeric_limits<double>::infinity();
  front_.used_ = front_.free_count_ = 0;
  if (front_.crowded_ && enough_ > 0) far_ = kFarSteps * enough_;
  leaves_.count = nodes_.count = 0;
  add(0, 0, kUnknown, {1, 0, 0});
  least_ = std::numeric_limits<float>::infinity();
  see_to(0);
}

// Takes from all gaps what the motion since may have closed. False: nothing worth a look is left of the front.
bool FrontWalk::advance() noexcept {
  leaves_.count = nodes_.count = 0;
  const Pose& before = front_.relative_;
  detail::Shift shift{};
  double square = 0;
  std::array<double, 9> turn{};
  for (std::size_t i = 0; i < 9; ++i) {
    turn[i] = relative_.scale * relative_.rotation[i] - before.scale * before.rotation[i];
    square += turn[i] * turn[i];
    shift.turn[i] = static_cast<float>(turn[i]);
  }
  // As in coherence.cpp: two rotations differ by one about an axis.
  const double swing = std::sqrt(relative_.scale == before.scale ? square / 2 : square);
  const ObbNodeBlock& root = second_.obb_nodes[0];
  const Vec3 middle = {root.x[0], root.y[0], root.z[0]};
  Vec3 way{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double by = relative_.translation[i] - before.translation[i];
    way[i] = turn[3 * i] * middle[0] + turn[3 * i + 1] * middle[1] + turn[3 * i + 2] * middle[2] + by;
    shift.by[i] = static_cast<float>(by);
  }
  const double moved = length(way) + swing * double{root.radius[0]};
  const double error = double{placement_.margin} + kAxisError * (moved + length(middle) * swing);
  enough_ = static_cast<float>(moved);
  front_.rest_ -= moved + error;
  if (!(front_.rest_ > 0) || !std::isfinite(moved)) return false;
  shift.swing = static_cast<float>(swing * (1 + 1e-6));
  shift.error = static_cast<float>(error * (1 + 1e-6));
  front_.relative_ = relative_;
  constexpr std::uint32_t word = 64;
  std::array<std::uint64_t, PairFront::kRoom / word> open;
  least_ = detail::close_gaps(shift, front_.blocks_.data(), block_count(), open.data());
  const std::uint32_t count = block_count() * kBlockWidth;
  for (std::uint32_t from = 0; from < count; from += word) {
    for (std::uint64_t left = open[from / word]; left != 0; left &= left - 1) {
      see_to(from + static_cast<std::uint32_t>(std::countr_zero(left)));
    }
  }
  return leaves_.count + nodes_.count <= kMostOpen;
}

FrontWalk::Outcome FrontWalk::settle_leaves() noexcept {
  for (std::uint32_t i = 0; i < leaves_.count; ++i) {
    if (tracker_->exhausted()) return Outcome::interrupted;
    detail::FrontBlock& block = front_.blocks_[leaves_.slots[i] / kBlockWidth];
    const std::uint32_t lane = leaves_.slots[i] % kBlockWidth;
    LeafAxis axis = {0, {block.ux[lane], block.uy[lane], block.uz[lane]}};
    const std::array<float, 3> last = axis.u;
    if (leaves_meet({block.a[lane], block.b[lane]}, &last, axis)) return Outcome::meeting;
    block.gap[lane] = axis.gap;
    note(axis.gap);
    block.ux[lane] = axis.u[0], block.uy[lane] = axis.u[1], block.uz[lane] = axis.u[2];
  }
  return Outcome::apart;
}

// Eight at a time: those that are apart along another direction stay, the others make room for what is below them.
FrontWalk::Outcome FrontWalk::settle_nodes() noexcept {
  ObbNodeBlock firsts, seconds;
  BoxAxes axes;
  for (std::uint32_t from = 0; from < nodes_.count; from += kBlockWidth) {
    const std::uint32_t count = std::min(nodes_.count - from, kBlockWidth);
    for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
      const std::uint32_t slot = nodes_.slots[from + (i < count ? i : 0)];
      const detail::FrontBlock& block = front_.blocks_[slot / kBlockWidth];
      const auto copy = [i](ObbNodeBlock& to, const TreeView& tree, std::uint32_t node) {
        const ObbNodeBlock& of = tree.obb_nodes[node / kBlockWidth];
        const std::uint32_t lane = node % kBlockWidth;
        to.x[i] = of.x[lane], to.y[i] = of.y[lane], to.z[i] = of.z[lane];
        to.nx[i] = of.nx[lane], to.ny[i] = of.ny[lane], to.nz[i] = of.nz[lane];
        to.mx[i] = of.mx[lane], to.my[i] = of.my[lane], to.mz[i] = of.mz[lane];
        to.radius[i] = of.radius[lane], to.height[i] = of.height[lane];
        to.width[i] = of.width[lane], to.length[i] = of.length[lane];
      };
      copy(firsts, first_, block.a[slot % kBlockWidth]);
      copy(seconds, second_, block.b[slot % kBlockWidth]);
    }
    detail::box_pair_axes(firsts, seconds, placement_, placement_.box_margin, axes);
    tracker_->spend(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t slot = nodes_.slots[from + i], lane = slot % kBlockWidth;
      detail::FrontBlock& block = front_.blocks_[slot / kBlockWidth];
      if ((axes.meeting >> i & 1) == 0) {
        block.gap[lane] = axes.gap[i];
        note(axes.gap[i]);
        block.ux[lane] = axes.ux[i], block.uy[lane] = axes.uy[i], block.uz[lane] = axes.uz[i];
        continue;
      }
      if (tracker_->exhausted()) return Outcome::interrupted;
      const NodePair pair = {block.a[lane], block.b[lane]};
      release(slot);
      if (const Outcome outcome = walk(pair); outcome != Outcome::apart) return outcome;
    }
  }
  return Outcome::apart;
}

// Depth first, as NarrowPhase does; what is apart joins the front.
FrontWalk::Outcome FrontWalk::walk(const NodePair& from) noexcept {
  stack_[stack_size_++] = from;
  while (stack_size_ > 0) {
    if (tracker_->exhausted()) return keep_stack(), Outcome::interrupted;
    const NodePair pair = stack_[--stack_size_];
    if (is_leaf_pair(pair.a, pair.b)) {
      LeafAxis axis;
      const bool meet = leaves_meet(pair, nullptr, axis);
      add(pair.a, pair.b, axis.gap, axis.u);
      if (meet) return keep_stack(), Outcome::meeting;
      continue;
    }
    expand(pair, detail::larger_node(first_, second_, pair, placement_.scale));
  }
  return Outcome::apart;
}

bool FrontWalk::leaves_meet(const NodePair& pair, const Axis* last, LeafAxis& axis) noexcept {
  const TriangleBlock& lanes = first_.triangle_blocks[detail::slab_child(first_, pair.a) & ~kLeafBit];
  const TriangleBlock& rows = second_.triangle_blocks[detail::slab_child(second_, pair.b) & ~kLeafBit];
  const detail::NodeBox lane_box = detail::node_box_at(first_, pair.a),
                        row_box = detail::moved(detail::node_box_at(second_, pair.b), placement_);
  const detail::LeafPair leaves = {lanes, rows, lane_box, row_box};
  axis = detail::leaf_axis(leaves, placement_, last, enough_);
  tracker_->spend(kBlockWidth);
  if (axis.gap > 0) return false;
  tracker_->spend(std::uint64_t{kLeafPairTests} * kTriangleTestCost);
  return search_.test_leaves(pair);
}

void FrontWalk::expand(const NodePair& pair, const detail::Opened& opened) noexcept {
  BoxAxes axes;
  const float margin = placement_.box_margin;
  if (opened.second) {
    detail::box_axes(detail::moved_back(detail::node_box_at(first_, pair.a), placement_),
                     second_.obb_nodes[opened.block], &placement_, margin, axes);
  } else {
    detail::box_axes(detail::moved(detail::node_box_at(second_, pair.b), placement_), first_.obb_nodes[opened.block],
                     nullptr, margin, axes);
  }
  tracker_->spend(static_cast<std::uint64_t>(std::bit_width(axes.used)));
  const float sign = opened.second ? 1.0f : -1.0f;
  for (std::uint32_t left = axes.used & ~axes.meeting; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    const NodePair child = opened.pair(pair, lane);  // vectors point from the single one to the eight
    add(child.a, child.b, axes.gap[lane], {sign * axes.ux[lane], sign * axes.uy[lane], sign * axes.uz[lane]});
  }
  stack_size_ = detail::push_farthest_first(
      &stack_[0], stack_size_, axes.meeting,
      [&](std::uint32_t lane) ORCHARD_INLINE_LAMBDA { return opened.pair(pair, lane); },
      [&](const NodePair&, std::uint32_t lane) ORCHARD_INLINE_LAMBDA { return axes.gap[lane]; });
}

void FrontWalk::add(std::uint32_t a, std::uint32_t b, float gap, const Axis& u) noexcept {
  std::uint32_t slot = front_.used_;
  if (gap > far_) {
    front_.rest_ = std::min(front_.rest_, double{gap});
    return;
  }
  if (front_.free_count_ > 0) {
    slot = front_.free_[--front_.free_count_];
  } else if (slot < PairFront::kRoom) {
    if (slot % kBlockWidth == 0) front_.blocks_[slot / kBlockWidth].gap.fill(kUnused);
    ++front_.used_;
  } else {
    front_.crowded_ = true;
    front_.rest_ = std::min(front_.rest_, double{gap});
    return;
  }
  detail::FrontBlock& block = front_.blocks_[slot / kBlockWidth];
  const std::uint32_t lane = slot % kBlockWidth;
  const ObbNodeBlock& of = second_.obb_nodes[b / kBlockWidth];
  const std::uint32_t at = b % kBlockWidth;
  block.x[lane] = of.x[at], block.y[lane] = of.y[at], block.z[lane] = of.z[at], block.radius[lane] = of.radius[at];
  block.ux[lane] = u[0], block.uy[lane] = u[1], block.uz[lane] = u[2];
  block.gap[lane] = gap;
  note(gap);
  block.a[lane] = a, block.b[lane] = b;
}

// What a search that has ended has not come to.
void FrontWalk::keep_stack() noexcept {
  while (stack_size_ > 0) {
    const NodePair& pair = stack_[--stack_size_];
    add(pair.a, pair.b, kUnknown, {1, 0, 0});
  }
}

void FrontWalk::release(std::uint32_t slot) noexcept {
  front_.blocks_[slot / kBlockWidth].gap[slot % kBlockWidth] = kUnused;
  front_.free_[front_.free_count_++] = static_cast<std::uint16_t>(slot);
}

}  // namespace orchard::runtime
