#include <bit>
#include <cmath>
#include <limits>

#include "ball_slab_block.h"
#include "ball_slab_pair.h"
#include "triangle_tests.h"

// The inner loops of ball_slab_block.cpp one number at a time: the same operations, but only those whose results are
// asked for.
namespace orchard::runtime::detail {
namespace {

using E = Eight<OneFloat>;
using Vectors = E::Vectors;

// The balls alone, as BallSlabPair finds their gap.
bool balls_apart(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement, float margin,
                 std::uint32_t i) noexcept {
  const Vectors own = {lanes.x[i], lanes.y[i], lanes.z[i]};
  const Vectors d = E::minus(placement != nullptr ? E::move(*placement, own) : own, {single.x, single.y, single.z});
  const float radius = placement != nullptr ? lanes.radius[i] * placement->scale : lanes.radius[i];
  return std::sqrt(E::dot(d, d)) - (radius + single.radius) - margin > 0;
}

ORCHARD_INLINE void find_gaps(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement,
                              float margin, bool only_meeting, BallSlabGaps& result) noexcept {
  std::uint32_t used = 0, meeting = 0;
  for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
    if (!(lanes.radius[i] >= 0)) continue;
    used |= 1u << i;
    if (only_meeting && balls_apart(single, lanes, placement, margin, i)) continue;
    const BallSlabPair<OneFloat> pair(single, lanes, placement, result, i);
    const float gap = E::larger(E::larger(pair.by_n, pair.by_m), pair.by_line) - margin;
    result.gap[i] = gap;
    meeting |= std::uint32_t{gap <= 0} << i;
  }
  result.used = used;
  result.meeting = meeting;
}

struct Triangle {
  Vectors corner[3];
  Box<OneFloat> box;
};

// Those of a leaf, `placement` moves them unless it is null, that may reach into the other one's ball slab.
struct Leaf {
  Triangle triangle[kBlockWidth];
  std::uint32_t left = 0;

  Leaf(const TriangleBlock& block, const Placement* placement, const BallSlab& other, float grown,
       float margin) noexcept {
    for (std::uint32_t i = 0; i < kBlockWidth && block.triangle[i] != kNoTriangle; ++i) {
      Triangle& t = triangle[i];
      for (std::size_t k = 0; k < 3; ++k) {
        t.corner[k] = E::corner(block, k, i);
        if (placement != nullptr) t.corner[k] = E::move(*placement, t.corner[k]);
      }
      if (beyond_planes<OneFloat>(t.corner, other, margin)) continue;
      t.box = box_of<OneFloat>(t.corner, grown);
      if (!beside_ball<OneFloat>(t.box, other, margin)) left |= 1u << i;
    }
  }
};

bool meet(const Box<OneFloat>& a, const Box<OneFloat>& b) noexcept {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

Lanes<OneFloat> planes_of(const Triangle& t, float unit, float margin) noexcept {
  const Vectors corner[3] = {E::times(t.corner[0], unit), E::times(t.corner[1], unit), E::times(t.corner[2], unit)};
  const Vectors edge[2] = {E::minus(corner[1], corner[0]), E::minus(corner[2], corner[0])};
  const Vectors normal = E::cross(edge[0], edge[1]);
  return {{corner[0], corner[1], corner[2]},
          {edge[0], E::minus(corner[2], corner[1]), edge[1]},
          normal,
          own_height<OneFloat>(normal, edge, margin)};
}

}  // namespace

void ball_slab_gaps_scalar(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement, float margin,
                           BallSlabGaps& result) noexcept {
  find_gaps(single, lanes, placement, margin, false, result);
}

void meeting_ball_slabs_scalar(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement,
                               float margin, BallSlabGaps& result) noexcept {
  find_gaps(single, lanes, placement, margin, true, result);
}

std::uint64_t triangle_candidates_scalar(const LeafPair& pair, const Placement& placement) noexcept {
  const Leaf lanes(pair.lanes, nullptr, pair.row_slab, placement.margin, placement.margin);
  if (lanes.left == 0) return 0;
  const Leaf rows(pair.rows, &placement, pair.lane_slab, 0, placement.margin);
  const float margin = placement.margin * placement.unit;
  Lanes<OneFloat> planes[kBlockWidth];
  std::uint32_t made = 0;
  std::uint64_t result = 0;
  for (std::uint32_t left_rows = rows.left; left_rows != 0; left_rows &= left_rows - 1) {
    const auto r = static_cast<std::uint32_t>(std::countr_zero(left_rows));
    Lanes<OneFloat> row;
    bool row_made = false;
    for (std::uint32_t left = lanes.left; left != 0; left &= left - 1) {
      const auto l = static_cast<std::uint32_t>(std::countr_zero(left));
      if (!meet(lanes.triangle[l].box, rows.triangle[r].box)) continue;
      if ((made >> l & 1) == 0) planes[l] = planes_of(lanes.triangle[l], placement.unit, margin), made |= 1u << l;
      if (!row_made) row = planes_of(rows.triangle[r], placement.unit, margin), row_made = true;
      const std::uint64_t near = not_apart<OneFloat>(1, planes[l], row.corner, row.normal, row.limit, margin);
      result |= near << (kBlockWidth * r + l);
    }
  }
  return result;
}

void triangle_gaps_scalar(const TriangleBlock& lanes, const TriangleBlock& rows, const Placement& placement,
                          const std::array<float, 3>& direction, float reach, TriangleGaps& result) noexcept {
  struct Lane {
    Vectors corner[3], normal, middle;
    Box<OneFloat> box;
  };
  const float margin = 2 * placement.margin * placement.unit;
  const auto lane_of = [&](const TriangleBlock& block, std::uint32_t i, bool moved) -> Lane {
    Lane t;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vectors corner = E::corner(block, k, i);
      t.corner[k] = E::times(moved ? E::move(placement, corner) : corner, placement.unit);
    }
    t.normal = normal_of<OneFloat>(t.corner), t.middle = middle_of<OneFloat>(t.corner);
    t.box = box_of<OneFloat>(t.corner, 0);
    return t;
  };
  Lane lane[kBlockWidth];
  for (std::uint32_t l = 0; l < kBlockWidth; ++l) lane[l] = lane_of(lanes, l, false);
  const Vectors given = {direction[0], direction[1], direction[2]};
  const auto used = [&](std::uint32_t l) { return l < kBlockWidth && lanes.triangle[l] != kNoTriangle; };
  result.near = {};
  result.beyond = std::numeric_limits<float>::infinity();
  for (std::uint32_t r = 0; r < kBlockWidth && rows.triangle[r] != kNoTriangle; ++r) {
    const Lane row = lane_of(rows, r, true);
    bool within = false;
    for (std::uint32_t l = 0; l < kBlockWidth; ++l) {
      const float gap = (gap_between<OneFloat>(lane[l].box, row.box.low, row.box.high) - margin) * placement.whole;
      result.lower[r][l] = gap;
      within = within || gap <= reach;
    }
    for (std::uint32_t l = 0; l < kBlockWidth && within; ++l) {
      const auto along = [&](const Vectors& axis) { return gap_along<OneFloat>(axis, lane[l].corner, row.corner); };
      const Vectors line = normalised<OneFloat>(E::minus(lane[l].middle, row.middle));
      const float gap =
          E::larger(E::larger(along(row.normal), along(lane[l].normal)), E::larger(along(line), along(given)));
      result.lower[r][l] = E::larger((gap - margin) * placement.whole, result.lower[r][l]);
    }
    for (std::uint32_t l = 0; used(l); ++l) {
      const float lower = result.lower[r][l];
      if (lower <= reach) {
        result.near[r] |= 1u << l;
      } else {
        result.beyond = E::smaller(result.beyond, lower);
      }
    }
  }
}

}  // namespace orchard::runtime::detail
