#include "collision/distance_search.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "collision/kernels/eight.h"
#include "collision/triangle_distance.h"
#include "math/vector_functions.h"
#include "tree/tree_nodes.h"

// The search goes depth first through the triangle BVHs of both trees, the nearest pair of nodes first, and leaves out
// pairs that are not nearer than the best so far. Lower bounds are floats from which their rounding error has been
// subtracted; distances of triangles are doubles.
namespace orchard::runtime {

namespace {

constexpr double kDistanceRounding = 1e-12;  // the relative rounding error of distances in double
constexpr double kSmallMargin = 0.125;       // relative to two leaves' radii; most of their triangles are farther apart

}  // namespace

bool DistanceSearch::bind(const PreparedTree& a, const PreparedTree& b) noexcept {
  trees_.bind(a, b);
  finished_ = true;
  lower_ = 0;
  upper_ = std::numeric_limits<double>::infinity();
  return !have_triangles(trees_) || stack_.reserve(first(), second());
}

void DistanceSearch::start(const Pose& a, const Pose& b, const Tolerance& tolerance) noexcept {
  tolerance_ = tolerance;
  begin(a, b, std::numeric_limits<double>::infinity());
}

void DistanceSearch::start_within(const Pose& a, const Pose& b, double limit) noexcept {
  tolerance_ = {0, 0};
  begin(a, b, limit);
}

void DistanceSearch::begin(const Pose& a, const Pose& b, double limit) noexcept {
  Roots roots;
  const Roots::Answer answer = trees_.test_roots(a, b, roots);
  lower_ = roots.lower_bound;
  work_ = 0;
  stack_.clear();
  nearest_.distance = min_lower_ = std::numeric_limits<double>::infinity();
  nearest_.direction = {};
  nearest_.triangle_first = nearest_.triangle_second = kNoTriangle;
  upper_ = std::numeric_limits<double>::infinity();
  limit_ = {};
  finished_ = !has_room() || answer == Roots::Answer::refused || lower_ > limit ||  // level 0 has decided
              !trees_.place(a, b);
  if (finished_) return;
  if (limit < std::numeric_limits<double>::infinity()) {
    // The search goes beyond the limit by as much as the bounds lose to rounding when they are reported, so that
    // "farther" is certain.
    const double error = trees_.exact_error(), scale = trees_.first_pose().scale;
    limit_.length = (limit + 2 * error) / scale * (1 + 4 * kDistanceRounding);
    limit_.enough = std::max(0.0, (limit - error) / scale * (1 - 4 * kDistanceRounding));
  }
  find_cut();
  stack_.start({{0, 0}, 0});
}

// Sets the bound beyond which pairs are left out: they are farther than the limit, or not nearer than the nearest
// triangles by more than the tolerance.
void DistanceSearch::find_cut() noexcept {
  const double absolute = tolerance_.absolute > 0 ? tolerance_.absolute / trees_.first_pose().scale : 0;
  cut_ = std::min(limit_.length, (nearest_.distance - absolute) / (1 + tolerance_.relative));
  below_nearest_ = nearest_.distance <= limit_.length;
}

bool DistanceSearch::may_be_nearer(double lower) const noexcept {
  return below_nearest_ ? lower < cut_ : lower <= cut_;
}

void DistanceSearch::refine(const Budget& budget) noexcept {
  if (finished_ || budget.work == 0) return;
  PairBudget tracker(budget);
  const detail::PlacedViews trees = trees_.views();
  while (!stack_.empty() && nearest_.distance > limit_.enough && !tracker.exhausted()) {
    const Apart pair = stack_.pop();
    if (!may_be_nearer(double{pair.lower})) {
      min_lower_ = std::min(min_lower_, double{pair.lower});
      continue;
    }
    if (trees.are_leaves(pair)) {
      compare_leaves(trees, pair);
      tracker.spend(std::uint64_t{kLeafPairTests} * kTriangleTestCost);
    } else {
      expand(trees, pair);
      tracker.spend(kBlockWidth);
    }
  }
  if (nearest_.distance <= limit_.enough) leave_the_rest();
  finished_ = stack_.empty();
  work_ += tracker.spent();
  report();
}

// Ends the search at a distance that is near enough. The pairs on the stack still count for the lower bound.
void DistanceSearch::leave_the_rest() noexcept {
  for (const Apart& pair : stack_.all()) min_lower_ = std::min(min_lower_, double{pair.lower});
  stack_.clear();
}

// Replaces a pair by those of its children that may be nearer than the best, the nearest last. Among children that
// overlap, the deepest overlap comes last.
void DistanceSearch::expand(const detail::PlacedViews& trees, const Apart& pair) noexcept {
  const detail::Opened opened = trees.open(pair);
  detail::BoxGaps gaps;
  trees.compare_children(pair, opened, gaps);
  const detail::Within some = detail::within(gaps.gap, cut_);
  min_lower_ = std::min(min_lower_, std::max(0.0, double{some.beyond}));
  stack_.push(
      some.lanes,
      [&](std::uint32_t lane) ORCHARD_INLINE_LAMBDA -> Apart {
        return {opened.pair(pair, lane), pair.lower > 0 ? std::max(gaps.gap[lane], pair.lower) : gaps.gap[lane]};
      },
      [](const Apart& apart, std::uint32_t) ORCHARD_INLINE_LAMBDA { return apart.lower; });
}

// The nearest triangles come first, because each distance that is found rules out others.
void DistanceSearch::compare_leaves(const detail::PlacedViews& trees, const Apart& pair) noexcept {
  const TriangleBlock &lanes = trees.lanes(pair), &rows = trees.rows(pair);
  if (limit_.length < kSmallMargin * double{trees.radii(pair)}) return find_within(trees, pair);
  detail::TriangleGaps gaps;
  const float reach = detail::next_float(std::min(cut_, 1e30));
  detail::triangle_gaps(lanes, rows, trees.placement, nearest_.direction, reach, gaps);
  const float least = std::max(0.0f, pair.lower);
  const float left_out = detail::each_nearest_first(gaps, [&](std::uint32_t lane, std::uint32_t row, float lower) {
    // The remaining triangles are no nearer than these two, and no nearer than the boxes of the leaves.
    if (nearest_.distance <= limit_.enough || !may_be_nearer(double{std::max(lower, least)})) return false;
    compare_triangles(lanes, lane, rows, row, lower <= 0);
    return true;
  });
  if (left_out < std::numeric_limits<float>::infinity()) {
    min_lower_ = std::min(min_lower_, double{std::max(left_out, least)});
  }
}

// Finds only whether some triangles are within the limit. It uses the test for triangles that may meet, with a margin
// that includes the limit.
void DistanceSearch::find_within(const detail::PlacedViews& trees, const Apart& pair) noexcept {
  detail::Placement near = trees.placement;
  near.margin = detail::next_float((double{near.margin} + limit_.length) * (1 + 1e-6));
  min_lower_ = std::min(min_lower_, limit_.length);
  const bool found = detail::PlacedViews{trees.first, trees.second, near, trees.relative}.each_candidate(
      pair, [&](std::uint32_t lane, std::uint32_t row) {
        compare_triangles(trees.lanes(pair), lane, trees.rows(pair), row, true);
        return nearest_.distance <= limit_.enough;
      });
  if (found) min_lower_ = std::min(min_lower_, std::max(0.0, double{pair.lower}));
}

void DistanceSearch::compare_triangles(const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows,
                                       std::uint32_t row, bool may_meet) noexcept {
  const detail::TrianglePoints a = detail::points_of(lanes, lane),
                               b = detail::moved_points_of(rows, row, trees_.relative());
  Vec3 common{};
  const bool meet = may_meet && detail::triangles_intersect(a, b, &common);
  const detail::NearestPoints nearest = meet ? detail::NearestPoints{0, common, common} : detail::nearest_points(a, b);
  const double error = detail::kParallelError * (detail::longest_edge(a) + detail::longest_edge(b));
  min_lower_ = std::min(min_lower_, std::max(0.0, nearest.distance * (1 - kDistanceRounding) - error));
  if (nearest.distance >= nearest_.distance) return;
  nearest_.distance = nearest.distance;
  find_cut();
  nearest_.on_first = nearest.on_a, nearest_.on_second = nearest.on_b;
  nearest_.triangle_first = lanes.triangle[lane], nearest_.triangle_second = rows.triangle[row];
  if (nearest_.distance == 0) return;
  for (std::size_t i = 0; i < 3; ++i) {
    nearest_.direction[i] = static_cast<float>((nearest_.on_second[i] - nearest_.on_first[i]) / nearest_.distance);
  }
}

// Updates the bounds. They never get worse from call to call, even if rounding makes new ones worse.
void DistanceSearch::report() noexcept {
  double least = std::min(min_lower_, nearest_.distance);
  for (const Apart& pair : stack_.all()) least = std::min(least, double{pair.lower});
  const double scale = trees_.first_pose().scale, error = trees_.exact_error();
  if (std::isfinite(least)) lower_ = std::max(lower_, least * scale * (1 - kDistanceRounding) - error);
  upper_ = std::min(upper_, nearest_.distance * scale * (1 + kDistanceRounding) + error);
  lower_ = std::min(lower_, upper_);  // they cross only for a file whose ball slabs do not contain their triangles
}

DistanceSearch::Points DistanceSearch::points() const noexcept {
  Points result;
  if (nearest_.triangle_first == kNoTriangle) return result;
  result = {trees_.in_world(nearest_.on_first), trees_.in_world(nearest_.on_second), nearest_.triangle_first,
            nearest_.triangle_second};
  if (trees_.exchanged()) {
    std::swap(result.on_a, result.on_b);
    std::swap(result.triangle_a, result.triangle_b);
  }
  return result;
}

}  // namespace orchard::runtime
