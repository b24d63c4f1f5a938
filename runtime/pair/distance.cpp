#include "orchard/runtime/distance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>

#include "meter.h"
#include "tree/patch_block.h"
#include "triangle_distance.h"

// Depth first through the two trees of triangles, the nearest pair of patches first, leaving out what is not nearer
// than the best so far. Lower bounds are floats with their rounding taken off; distances of triangles are doubles.
namespace orchard::runtime {

namespace {

constexpr double kRounding = 1e-12;  // of distances in double, relative to them

std::uint32_t child_of(const TreeView& tree, std::uint32_t node) noexcept {
  return tree.patches[node / kBlockWidth].child[node % kBlockWidth];
}

}  // namespace

DistanceQuery::DistanceQuery(const TreeView& a, const TreeView& b) noexcept : pair_(a, b, 1) {
  const std::size_t deepest = std::size_t{kBlockWidth} * (a.patch_depth + b.patch_depth + 1) + 1;
  if (pair_.has_triangles()) stack_.reset(new (std::nothrow) PatchPair[deepest]);
}

void DistanceQuery::start(const Pose& a, const Pose& b, const Tolerance& tolerance) noexcept {
  tolerance_ = tolerance;
  pair_.start(a, b);
  pair_.keep(a, b);  // which start() does not where the roots decide
  lower_ = pair_.lower_bound();
  work_ = 0;
  stack_size_ = 0;
  nearest_ = least_lower_ = std::numeric_limits<double>::infinity();
  direction_ = {};
  triangle_first_ = triangle_second_ = kNoTriangle;
  upper_ = std::numeric_limits<double>::infinity();
  finished_ = !stack_ || pair_.refused() || !pair_.in_range();
  if (finished_) return;
  pair_.place();
  const TreeView& second = pair_.second_.tree;
  stack_[stack_size_++] = {0, 0, 0, detail::moved(detail::patch_at(second.patches[0], 0), pair_.placement_)};
}

bool DistanceQuery::worth_a_look(double lower) const noexcept {
  return lower * (1 + tolerance_.relative) + tolerance_.absolute / pair_.first_pose_.scale < nearest_;
}

void DistanceQuery::refine(const Budget& budget) noexcept {
  if (finished_ || budget.pair_tests == 0) return;
  NarrowPhase::Meter meter(budget);
  const TreeView &first = pair_.first_.tree, &second = pair_.second_.tree;
  while (stack_size_ > 0 && nearest_ > 0 && !meter.exhausted()) {
    const PatchPair pair = stack_[--stack_size_];
    if (!worth_a_look(double{pair.lower})) {
      least_lower_ = std::min(least_lower_, double{pair.lower});
      continue;
    }
    const std::uint32_t a = child_of(first, pair.a), b = child_of(second, pair.b);
    if (a & b & kLeafBit) {
      compare_leaves(pair);
      meter.spend(std::uint64_t{kLeafPairTests} * kTriangleTestCost);
      continue;
    }
    const float radius = first.patches[pair.a / kBlockWidth].radius[pair.a % kBlockWidth];
    const bool open_second = (a & kLeafBit) != 0 || ((b & kLeafBit) == 0 && radius < pair.second.radius);
    expand(pair, open_second ? b : a, open_second);
    meter.spend(kBlockWidth);
  }
  if (nearest_ == 0) stack_size_ = 0;
  finished_ = stack_size_ == 0;
  work_ += meter.spent();
  report();
}

// In place of a pair, those of its children that may be nearer than the best, the nearest last.
void DistanceQuery::expand(const PatchPair& pair, std::uint32_t block, bool second) noexcept {
  const TreeView &first = pair_.first_.tree, &tree = (second ? pair_.second_ : pair_.first_).tree;
  const detail::Placement& placement = pair_.placement_;
  detail::PatchGaps gaps;
  if (second) {
    detail::patch_gaps(detail::patch_at(first.patches[pair.a / kBlockWidth], pair.a % kBlockWidth), tree.patches[block],
                       &placement, placement.margin, gaps);
  } else {
    detail::patch_gaps(pair.second, tree.patches[block], nullptr, placement.margin, gaps);
  }
  const std::size_t begin = stack_size_;
  for (std::uint32_t left = gaps.used; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    // Overlapping patches keep their depth for the order: the deepest first.
    const float lower = pair.lower > 0 ? std::max(gaps.gap[lane], pair.lower) : gaps.gap[lane];
    if (!worth_a_look(std::max(0.0, double{lower}))) {
      least_lower_ = std::min(least_lower_, std::max(0.0, double{lower}));
      continue;
    }
    std::size_t at = stack_size_++;
    for (; at > begin && stack_[at - 1].lower < lower; --at) stack_[at] = stack_[at - 1];
    const std::uint32_t node = block * kBlockWidth + lane;
    stack_[at] =
        second ? PatchPair{lower, pair.a, node, gaps.patch(lane)} : PatchPair{lower, node, pair.b, pair.second};
  }
}

void DistanceQuery::compare_leaves(const PatchPair& pair) noexcept {
  const TreeView &first = pair_.first_.tree, &second = pair_.second_.tree;
  const TriangleBlock& lanes = first.triangle_blocks[child_of(first, pair.a) & ~kLeafBit];
  const TriangleBlock& rows = second.triangle_blocks[child_of(second, pair.b) & ~kLeafBit];
  detail::TriangleGaps gaps;
  detail::triangle_gaps(lanes, rows, pair_.placement_, direction_, gaps);
  for (std::uint32_t row = 0; row < kBlockWidth && rows.triangle[row] != kNoTriangle; ++row) {
    for (std::uint32_t lane = 0; lane < kBlockWidth && lanes.triangle[lane] != kNoTriangle; ++lane) {
      const double lower = std::max({0.0, double{gaps.lower[row][lane]}, double{pair.lower}});
      if (worth_a_look(lower)) {
        compare_triangles(lanes, lane, rows, row);
      } else {
        least_lower_ = std::min(least_lower_, lower);
      }
    }
  }
}

void DistanceQuery::compare_triangles(const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows,
                                      std::uint32_t row) noexcept {
  const detail::TrianglePoints a = detail::points_of(lanes, lane),
                               b = detail::moved_points_of(rows, row, pair_.relative_);
  detail::NearestPoints nearest = detail::nearest_points(a, b);
  const double error = detail::kParallelError * (detail::longest_edge(a) + detail::longest_edge(b));
  detail::Vec3 common{};
  if (detail::triangles_intersect(a, b, &common)) nearest = {0, common, common};
  least_lower_ = std::min(least_lower_, std::max(0.0, nearest.distance * (1 - kRounding) - error));
  if (nearest.distance >= nearest_) return;
  nearest_ = nearest.distance;
  on_first_ = nearest.on_a, on_second_ = nearest.on_b;
  triangle_first_ = lanes.triangle[lane], triangle_second_ = rows.triangle[row];
  if (nearest_ == 0) return;
  for (std::size_t i = 0; i < 3; ++i) {
    direction_[i] = static_cast<float>((on_second_[i] - on_first_[i]) / nearest_);
  }
}

// Bounds never get worse, whatever rounding does.
void DistanceQuery::report() noexcept {
  double least = std::min(least_lower_, nearest_);
  for (std::size_t i = 0; i < stack_size_; ++i) least = std::min(least, double{stack_[i].lower});
  const double scale = pair_.first_pose_.scale, error = pair_.exact_error_;
  if (std::isfinite(least)) lower_ = std::max(lower_, least * scale * (1 - kRounding) - error);
  upper_ = std::min(upper_, nearest_ * scale * (1 + kRounding) + error);
  lower_ = std::min(lower_, upper_);  // they only ever cross in a file whose patches do not hold their triangles
}

DistanceQuery::Points DistanceQuery::points() const noexcept {
  Points result;
  if (triangle_first_ == kNoTriangle) return result;
  const auto world = [this](std::array<double, 3> point) {
    for (std::size_t i = 0; i < 3; ++i) point[i] += pair_.first_.tree.origin[i];
    return transform(pair_.first_pose_, point);
  };
  result = {world(on_first_), world(on_second_), triangle_first_, triangle_second_};
  if (pair_.exchanged_) {
    std::swap(result.on_a, result.on_b);
    std::swap(result.triangle_a, result.triangle_b);
  }
  return result;
}

}  // namespace orchard::runtime
