#include <algorithm>
#include <bit>
#include <utility>

#include "collision/impact_search.h"
#include "collision/triangle_distance.h"

// Which triangles of two moving bodies can meet first.
namespace orchard::runtime::detail {
namespace {

constexpr double kEnough = 0.5;  // of the earliest time found: what may meet later than that is not looked at

}  // namespace

// When triangles can meet first, within what is left of the time. False if the budget ends before all was looked at:
// critical.time then holds for what was left, too.
bool ImpactSearch::find_critical(PairBudget& tracker, Critical& critical) noexcept {
  Scratch& scratch = *workspace_.scratch();
  Scratch::TimedPair* const stack = scratch.timed.data();
  std::size_t size = 0;
  stack[size++] = {0, 0, 0, moved(obb_node_at(second().obb_nodes[0], 0), trees_.placement())};
  while (size > 0) {
    if (tracker.exhausted()) {
      for (std::size_t i = 0; i < size; ++i) {
        critical.time = std::min(critical.time, std::max(0.0, double{stack[i].time}));
      }
      return false;
    }
    const Scratch::TimedPair top = stack[--size];
    if (critical.leaves(double{top.time})) continue;
    const std::uint32_t a = slab_child(first(), top.a), b = slab_child(second(), top.b);
    if (a & b & kLeafBit) {
      compare_leaves(top, critical);
      tracker.spend(std::uint64_t{kLeafPairTests} * kTriangleTestCost);
    } else {
      expand(top, size, critical);
      tracker.spend(kBlockWidth);
    }
  }
  return true;
}

// In place of a pair, those of its children that may meet in time, the earliest last.
void ImpactSearch::expand(const Scratch::TimedPair& top, std::size_t& size, Critical& critical) noexcept {
  Scratch::TimedPair* const stack = workspace_.scratch()->timed.data();
  const Placement& placement = trees_.placement();
  const std::uint32_t a = slab_child(first(), top.a), b = slab_child(second(), top.b);
  const ObbNodeBlock& own = first().obb_nodes[top.a / kBlockWidth];
  const std::uint32_t own_lane = top.a % kBlockWidth;
  const bool open_second = (a & kLeafBit) != 0 || ((b & kLeafBit) == 0 && own.radius[own_lane] < top.second.radius);
  const std::uint32_t block = open_second ? b : a;
  const auto margin = static_cast<float>((double{placement.margin} + limits_.margin) * (1 + 1e-6));
  ObbNodeTimes times;
  if (open_second) {
    obb_node_times(obb_node_at(own, own_lane), second().obb_nodes[block], &placement, motion_.closing, margin, times);
  } else {
    obb_node_times(top.second, first().obb_nodes[block], nullptr, motion_.closing, margin, times);
  }
  const std::size_t begin = size;
  for (std::uint32_t left = times.used; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    const float time = top.time > 0 ? std::max(times.time[lane], top.time) : times.time[lane];
    if (critical.leaves(double{time})) continue;
    std::size_t at = size++;
    for (; at > begin && stack[at - 1].time < time; --at) stack[at] = stack[at - 1];
    const std::uint32_t node = block * kBlockWidth + lane;
    stack[at] = open_second ? Scratch::TimedPair{time, top.a, node, times.slab(lane)}
                            : Scratch::TimedPair{time, node, top.b, top.second};
  }
}

void ImpactSearch::compare_leaves(const Scratch::TimedPair& top, Critical& critical) noexcept {
  const TriangleBlock& lanes = first().triangle_blocks[slab_child(first(), top.a) & ~kLeafBit];
  const TriangleBlock& rows = second().triangle_blocks[slab_child(second(), top.b) & ~kLeafBit];
  const ObbNode p = obb_node_at(first().obb_nodes[top.a / kBlockWidth], top.a % kBlockWidth);
  const auto reach = [](const ObbNode& slab, const Vec3& center) {
    const Vec3 from = minus({slab.x, slab.y, slab.z}, center);
    return (length_of(from) + double{slab.radius}) * (1 + 1e-5);
  };
  const double first_reach = reach(p, motion_.first.center), second_reach = reach(top.second, motion_.second.center);
  const double fastest = length_of(motion_.velocity) + motion_.speed +
                         (motion_.first.spin + motion_.first.turning) * first_reach +
                         (motion_.second.spin + motion_.second.turning) * second_reach;
  // Before that no gap closes, whatever its direction.
  const auto earliest = [&](float lower) {
    const double gap = double{lower} - limits_.margin;
    return gap > 0 ? gap / (fastest * (1 + kImpactRounding)) : 0;
  };
  const double reach_in_time = fastest * (1 + kImpactRounding) * critical.cut + limits_.margin;
  TriangleGaps gaps;
  triangle_gaps(lanes, rows, trees_.placement(), direction_,
                static_cast<float>(std::min(reach_in_time * (1 + 1e-6), 1e30)), gaps);
  // The nearest first: each makes fewer of the others worth a look.
  std::array<std::uint8_t, std::size_t{kBlockWidth} * kBlockWidth> order;
  std::size_t count = 0;
  const auto lower_of = [&](std::uint8_t i) { return gaps.lower[i / kBlockWidth][i % kBlockWidth]; };
  for (std::uint32_t row = 0; row < kBlockWidth && rows.triangle[row] != kNoTriangle; ++row) {
    for (std::uint32_t lane = 0; lane < kBlockWidth && lanes.triangle[lane] != kNoTriangle; ++lane) {
      const float lower = gaps.lower[row][lane];
      if (critical.leaves(earliest(lower))) continue;
      std::size_t at = count++;
      for (; at > 0 && lower_of(order[at - 1]) > lower; --at) order[at] = order[at - 1];
      order[at] = static_cast<std::uint8_t>(kBlockWidth * row + lane);
    }
  }
  for (std::size_t i = 0; i < count && !critical.leaves(earliest(lower_of(order[i]))); ++i) {
    compare_triangles(lanes, order[i] % kBlockWidth, rows, order[i] / kBlockWidth, {fastest, first_reach, second_reach},
                      critical);
  }
}

void ImpactSearch::compare_triangles(const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows,
                                     std::uint32_t row, const Speeds& speeds, Critical& critical) noexcept {
  const TrianglePoints a = points_of(lanes, lane), b = moved_points_of(rows, row, trees_.relative());
  const NearestPoints nearest = nearest_points(a, b);
  const Vec3 way = minus(nearest.on_b, nearest.on_a);
  const double size = length_of(way);
  double gap = -1, rate = speeds.fastest;
  if (size > 0) {
    const Vec3 u = along({0, 0, 0}, way, 1 / size);
    const auto [low, high] = std::pair(std::min({dot(u, b[0]), dot(u, b[1]), dot(u, b[2])}),
                                       std::max({dot(u, a[0]), dot(u, a[1]), dot(u, a[2])}));
    gap = low - high - limits_.margin - limits_.error;
    rate = motion_.speed - dot(motion_.velocity, u) + motion_.first.rate(u, speeds.first_reach) +
           motion_.second.rate(u, speeds.second_reach) + kImpactRounding * speeds.fastest;
  }
  const double time = gap > 0 ? (rate > 0 ? gap / rate : std::numeric_limits<double>::infinity()) : 0;
  if (time >= critical.time) return;
  critical = {time,
              kEnough * time,
              nearest.distance,
              rate,
              nearest.on_a,
              nearest.on_b,
              lanes.triangle[lane],
              rows.triangle[row],
              critical.left_out};
  if (gap <= 0 && triangles_intersect(a, b, &critical.on_first)) {
    critical.distance = 0, critical.on_second = critical.on_first;
  }
  for (std::size_t i = 0; i < 3; ++i) direction_[i] = size > 0 ? static_cast<float>(way[i] / size) : 0;
}

}  // namespace orchard::runtime::detail
