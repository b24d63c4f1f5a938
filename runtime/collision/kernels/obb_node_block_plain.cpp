#include <bit>
#include <cmath>
#include <limits>

#include "collision/kernels/obb_node_block.h"
#include "collision/kernels/obb_node_pair.h"
#include "collision/kernels/triangle_tests.h"

// The inner loops of obb_node_block.cpp one number at a time: the same operations, but only those whose results are
// asked for.
namespace orchard::runtime::detail {
namespace {

using E = Eight<OneFloat>;
using Vectors = E::Vectors;

struct Triangle {
  Vectors corner[3];
  Box<OneFloat> box;
};

// Those of a leaf, `placement` moves them unless it is null, that may reach into the other one's box.
struct Leaf {
  Triangle triangle[kBlockWidth];
  std::uint32_t left = 0;

  Leaf(const TriangleBlock& block, const Placement* placement, const NodeBox& other, float grown,
       float margin) noexcept {
    for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
      if (block.triangle[i] == kNoTriangle) continue;
      Triangle& t = triangle[i];
      for (std::size_t k = 0; k < 3; ++k) {
        t.corner[k] = E::corner(block, k, i);
        if (placement != nullptr) t.corner[k] = E::move(*placement, t.corner[k]);
      }
      if (beyond_box<OneFloat>(t.corner, other, margin)) continue;
      t.box = box_of<OneFloat>(t.corner, grown);
      left |= 1u << i;
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

// All triangles of a leaf, moved by `placement` unless it is null, in units of Placement::whole. Unused places repeat
// the first one.
struct Corners {
  Triangle triangle[kBlockWidth];

  Corners(const TriangleBlock& block, const Placement* placement, float unit) noexcept {
    for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
      Triangle& t = triangle[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const Vectors corner = E::corner(block, k, i);
        t.corner[k] = E::times(placement != nullptr ? E::move(*placement, corner) : corner, unit);
      }
      t.box = box_of<OneFloat>(t.corner, 0);
    }
  }
  Extent<OneFloat> along(const Vectors& axis) const noexcept {
    Extent<OneFloat> all = extent_along<OneFloat>(axis, triangle[0].corner);
    for (std::uint32_t i = 1; i < kBlockWidth; ++i) {
      const Extent<OneFloat> own = extent_along<OneFloat>(axis, triangle[i].corner);
      all = {E::min(all.low, own.low), E::max(all.high, own.high)};
    }
    return all;
  }
};

}  // namespace

std::uint64_t triangle_candidates_scalar(const LeafPair& pair, const Placement& placement) noexcept {
  const Leaf lanes(pair.lanes, nullptr, pair.row_box, placement.margin, placement.margin);
  if (lanes.left == 0) return 0;
  const Leaf rows(pair.rows, &placement, pair.lane_box, 0, placement.margin);
  const float margin = placement.margin * placement.unit;
  Lanes<OneFloat> planes[kBlockWidth];
  std::uint32_t made = 0;
  std::uint64_t result = 0;
  for (std::uint32_t left_rows = rows.left; left_rows != 0; left_rows &= left_rows - 1) {
    const auto r = static_cast<std::uint32_t>(std::countr_zero(left_rows));
    std::uint32_t near = 0;
    for (std::uint32_t left = lanes.left; left != 0; left &= left - 1) {
      const auto l = static_cast<std::uint32_t>(std::countr_zero(left));
      if (meet(lanes.triangle[l].box, rows.triangle[r].box)) near |= 1u << l;
    }
    if (near == 0) continue;
    const Lanes<OneFloat> row = planes_of(rows.triangle[r], placement.unit, margin);
    for (; near != 0; near &= near - 1) {
      const auto l = static_cast<std::uint32_t>(std::countr_zero(near));
      if ((made >> l & 1) == 0) planes[l] = planes_of(lanes.triangle[l], placement.unit, margin), made |= 1u << l;
      const std::uint64_t left = not_apart<OneFloat>(1, planes[l], row.corner, row.normal, row.limit, margin);
      result |= left << (kBlockWidth * r + l);
    }
  }
  return result;
}

void triangle_gaps_scalar(const TriangleBlock& lanes, const TriangleBlock& rows, const Placement& placement,
                          const std::array<float, 3>& direction, float reach, TriangleGaps& result) noexcept {
  const float margin = 2 * placement.margin * placement.unit;
  const Vectors given = {direction[0], direction[1], direction[2]};
  const Corners lane(lanes, nullptr, placement.unit), row(rows, &placement, placement.unit);
  const Extent<OneFloat> lane_extent = lane.along(given), row_extent = row.along(given);
  const float all_beyond =
      (E::max(row_extent.low - lane_extent.high, lane_extent.low - row_extent.high) - margin) * placement.whole;
  result.near = {};
  if (!(all_beyond <= reach)) {
    for (auto& lower : result.lower) lower.fill(all_beyond);
    result.beyond = all_beyond;
    return;
  }
  result.beyond = std::numeric_limits<float>::infinity();
  std::uint32_t made = 0;  // of what lanes have
  Vectors normal[kBlockWidth], middle[kBlockWidth];
  for (std::uint32_t r = 0; r < kBlockWidth; ++r) {
    if (rows.triangle[r] == kNoTriangle) continue;
    const Box<OneFloat> row_box = box_of<OneFloat>(row.triangle[r].corner, 0);
    bool within = false;
    for (std::uint32_t l = 0; l < kBlockWidth; ++l) {
      result.lower[r][l] =
          (gap_between<OneFloat>(lane.triangle[l].box, row_box.low, row_box.high) - margin) * placement.whole;
      within = within || result.lower[r][l] <= reach;
    }
    const auto& p = row.triangle[r].corner;
    const Vectors row_normal = within ? normal_of<OneFloat>(p) : Vectors{}, row_middle = middle_of<OneFloat>(p);
    for (std::uint32_t l = 0; l < kBlockWidth; ++l) {
      float& lower = result.lower[r][l];
      if (within) {
        const auto& t = lane.triangle[l].corner;
        if ((made >> l & 1) == 0) {
          normal[l] = normal_of<OneFloat>(t), middle[l] = middle_of<OneFloat>(t);
          made |= 1u << l;
        }
        const auto along = [&](const Vectors& axis) { return gap_along<OneFloat>(axis, t, p); };
        const Vectors line = normalised<OneFloat>(E::minus(middle[l], row_middle));
        const float gap = E::max(E::max(along(row_normal), along(normal[l])), E::max(along(line), along(given)));
        lower = E::max((gap - margin) * placement.whole, lower);
      }
      if (lanes.triangle[l] == kNoTriangle) continue;
      if (lower <= reach) {
        result.near[r] |= 1u << l;
      } else {
        result.beyond = E::min(result.beyond, lower);
      }
    }
  }
}

}  // namespace orchard::runtime::detail
