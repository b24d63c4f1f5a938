#include <algorithm>
#include <bit>
#include <utility>

#include "collision/impact_search.h"
#include "collision/triangle_distance.h"

// Finds the triangles of two moving bodies that can meet first.
namespace orchard::runtime::detail {
namespace {

constexpr double kEnough = 0.5;  // relative to the earliest time found: what cannot meet before it is left out

}  // namespace

// Finds the triangles that can meet first, within the remaining time. Returns false if the budget ends the search;
// critical.time then holds for the pairs that were not looked at, too.
bool ImpactSearch::find_critical(PairBudget& tracker, Critical& critical) noexcept {
  TreeStack<Scratch::TimedPair>& stack = workspace_.scratch()->timed;
  const PlacedViews trees = trees_.views();
  for (stack.start({{0, 0}, 0}); !stack.empty();) {
    if (tracker.exhausted()) {
      for (const Scratch::TimedPair& pair : stack.all()) {
        critical.time = std::min(critical.time, std::max(0.0, double{pair.time}));
      }
      return false;
    }
    const Scratch::TimedPair top = stack.pop();
    if (critical.leaves(double{top.time})) continue;
    if (trees.are_leaves(top)) {
      compare_leaves(trees, top, critical);
      tracker.spend(std::uint64_t{kLeafPairTests} * kTriangleTestCost);
    } else {
      expand(trees, top, critical);
      tracker.spend(kBlockWidth);
    }
  }
  return true;
}

// Replaces a pair by those of its children that may meet in time, the earliest last.
void ImpactSearch::expand(const PlacedViews& trees, const Scratch::TimedPair& top, Critical& critical) noexcept {
  const Opened opened = trees.open(top);
  const auto margin = static_cast<float>((double{trees.placement.box_margin} + limits_.margin) * (1 + 1e-6));
  BoxTimes times;
  trees.with_children(top, opened, [&](const NodeBox& single, const ObbNodeBlock& block, float scale) {
    box_times(single, block, scale, opened.second ? motion_.of_second : motion_.of_first, margin, times);
  });
  std::uint32_t lanes = 0;
  for (std::uint32_t left = times.used; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    times.time[lane] = top.time > 0 ? std::max(times.time[lane], top.time) : times.time[lane];
    lanes |= std::uint32_t{!critical.leaves(double{times.time[lane]})} << lane;
  }
  workspace_.scratch()->timed.push(
      lanes,
      [&](std::uint32_t lane) {
        return Scratch::TimedPair{opened.pair(top, lane), times.time[lane]};
      },
      [](const Scratch::TimedPair& pair, std::uint32_t) { return pair.time; });
}

void ImpactSearch::compare_leaves(const PlacedViews& trees, const Scratch::TimedPair& top,
                                  Critical& critical) noexcept {
  const TriangleBlock &lanes = trees.lanes(top), &rows = trees.rows(top);
  const auto reach = [](const NodeBox& box, const Vec3& center) {
    const Vec3 from = minus({box.center[0], box.center[1], box.center[2]}, center);
    return (length(from) + double{box.radius}) * (1 + 1e-5);
  };
  const double first_reach = reach(trees.first_box(top), motion_.first.center),
               second_reach = reach(trees.second_box(top), motion_.second.center);
  const double fastest = length(motion_.velocity) + motion_.speed +
                         (motion_.first.spin + motion_.first.turning) * first_reach +
                         (motion_.second.spin + motion_.second.turning) * second_reach;
  // Returns a time before which no gap of at least `lower` can close, whatever its direction.
  const auto earliest = [&](float lower) {
    const double gap = double{lower} - limits_.margin;
    return gap > 0 ? gap / (fastest * (1 + kImpactRounding)) : 0;
  };
  const double reach_in_time = fastest * (1 + kImpactRounding) * critical.cut + limits_.margin;
  TriangleGaps gaps;
  triangle_gaps(lanes, rows, trees.placement, direction_,
                static_cast<float>(std::min(reach_in_time * (1 + 1e-6), 1e30)), gaps);
  // The nearest triangles come first, because each time that is found rules out others.
  const float others = each_nearest_first(gaps, [&](std::uint32_t lane, std::uint32_t row, float lower) {
    if (critical.leaves(earliest(lower))) return false;
    compare_triangles(lanes, lane, rows, row, {fastest, first_reach, second_reach}, critical);
    return true;
  });
  critical.left_out = std::min(critical.left_out, earliest(others));
}

void ImpactSearch::compare_triangles(const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows,
                                     std::uint32_t row, const Speeds& speeds, Critical& critical) noexcept {
  const TrianglePoints a = points_of(lanes, lane), b = moved_points_of(rows, row, trees_.relative());
  const NearestPoints nearest = nearest_points(a, b);
  const Vec3 way = minus(nearest.on_b, nearest.on_a);
  const double size = length(way);
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
